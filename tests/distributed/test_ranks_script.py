# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`benchmarks/ranks.py` gets the data for its tables and its model from the command and from Open MPI."""
import json
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESHORDER = pathlib.Path(os.environ.get("MESHORDER", ROOT / "build" / "bin" / "meshorder"))
STAGES = {"read", "distribute", "graph", "partition", "order", "cells", "write"}

if not MESHORDER.with_name("meshorder-mpi").exists():
    pytest.skip("needs a build with MESHORDER_MPI=ON", allow_module_level=True)


def rows(text, begin):
    return [line for line in text.splitlines() if line.startswith(begin)]


def test_runs_are_measured_and_predict_larger_ones(tmp_path):
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    done = subprocess.run(
        ["/usr/bin/python3", ROOT / "benchmarks" / "ranks.py", MESHORDER, "--sizes", "32000", "64000", "--ranks", "1", "2",
         "--vertices", "spectral", "--rounds", "1", "--mpirun", "mpirun --oversubscribe --bind-to none", "--folder", tmp_path,
         "--json", tmp_path / "runs.json", "--model"],
        env=environment, capture_output=True, text=True, timeout=120, check=True)
    runs = json.loads((tmp_path / "runs.json").read_text())
    assert [(run["vertices"], run["ranks"]) for run in runs] == [(32768, 1), (64000, 2), (64000, 1), (125000, 2)]
    for run in runs:
        several = run["ranks"] > 1
        assert set(run["stages"]) == (STAGES if several else {"read", "order", "write"})
        of_stages = sum(user for user, *_ in run["stages"].values())
        assert 0 < of_stages <= run["user"] + 0.1  # /proc counts in steps of 10 ms
        assert len(run.get("sent", [])) == (2 if several else 0)
        assert all(sent > 0 and messages > 0 for sent, messages in run.get("sent", []))
    # tables of weak scaling and of the model
    assert len(rows(done.stdout, "| 125,000 | 2 |")) == 2
    assert len(rows(done.stdout, "| 1,000,000,000 | 1,024 |")) == 1
    # the size of the files depends only on the number of vertices
    files = [line.split(" | ")[12] for line in rows(done.stdout, "| 100,000,000 |")]
    assert len(files) == 3 and len(set(files)) == 1
