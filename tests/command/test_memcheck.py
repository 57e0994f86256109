# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""One run of each subcommand under valgrind's memcheck: no read of what was never written, none beyond a block."""
import json
import shutil
import subprocess

import pytest

import conftest
import foam_cases
import meshes

pytestmark = [pytest.mark.long, pytest.mark.skipif(not shutil.which("valgrind"), reason="there is no valgrind")]
FOUND = 99


class Watched(conftest.Command):
    def run(self, *arguments, **options):
        return subprocess.run(
            ["valgrind", "--quiet", f"--error-exitcode={FOUND}", "--track-origins=yes", "--trace-children=no",
             f"--suppressions={conftest.ROOT / 'tests/command/memcheck.supp'}", conftest.MESHORDER,
             *map(str, arguments)],
            cwd=self.folder, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=3600, check=False,
            **options)


@pytest.fixture
def watched(tmp_path):
    meshes.write_tetgen(tmp_path)
    return Watched(tmp_path)


@pytest.mark.parametrize("arguments", [
    ["info", "mesh.node"],
    ["methods"],
    ["order", "mesh.node", "-o", "out.msh", "--maps", "maps"],
    ["compare", "mesh.node", "--budget", "0.01"],
    ["report", "mesh.node", "--budget", "0.01"],
    ["models", "list"],
    ["models", "make", "grid", "--size", "2"],
    ["simulate", "--list"],
    ["simulate", "constrained", "--mesh", "grid-2", "--steps", "2", "--threads", "2"],
    ["reproduce", "-o", "study", "--scenario", "constrained", "--mesh", "grid-2", "--steps", "2", "--runs", "1",
     "--budget", "0.01"],
], ids=" ".join)
def test_subcommand(watched, arguments, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(watched.folder / "cache"))
    watched.ok(*arguments)
