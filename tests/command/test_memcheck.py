# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Each subcommand once under valgrind's memcheck: no use of uninitialized memory, and no leaks."""
import shutil
import subprocess

import pytest

import conftest
import foam_cases
import meshes

pytestmark = [pytest.mark.long, pytest.mark.skipif(not shutil.which("valgrind"), reason="there is no valgrind")]
FOUND = 99
SMALL = ["--mesh", "grid-2", "--steps", "2"]


class Watched(conftest.Command):
    """Runs the command and its child processes under memcheck."""

    def run(self, *arguments, **options):
        # the command defines operator new and delete; where the compiler inlines one of them, valgrind replaces only
        # the other and would report a mismatch
        watched = ["valgrind", "--quiet", f"--error-exitcode={FOUND}", "--track-origins=yes", "--show-mismatched-frees=no",
                   "--trace-children=yes", "--trace-children-skip=*/gnuplot*", conftest.MESHORDER]
        return subprocess.run([*watched, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=3600, check=False, **options)


@pytest.fixture
def watched(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    meshes.write_tetgen(tmp_path)
    return Watched(tmp_path)


@pytest.mark.parametrize("arguments", [
    ["info", "mesh.node"],
    ["methods"],
    ["compare", "mesh.node", "--budget", "0.01"],
    ["report", "mesh.node", "--budget", "0.01"],
    ["models", "make", "grid", "--size", "2"],
    ["simulate", "--list"],
    ["simulate", "constrained", *SMALL, "--threads", "2"],
    ["reproduce", "-o", "study", "--scenario", "constrained", *SMALL, "--runs", "1", "--budget", "0.01"],
], ids=" ".join)
def test_subcommand(watched, arguments):
    watched.ok(*arguments)


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".vtk", ".mesh", ".node", ".veg", ".inp", ".bdf", ".unv", ".su2"])
def test_order_and_apply(watched, suffix):
    """Formats that need third-party libraries are left out: HDF5 writes uninitialized bytes."""
    watched.ok("order", "mesh.node", "-o", f"ordered{suffix}", "--maps", "maps")
    watched.ok("apply", "maps", f"ordered{suffix}", "-o", f"back{suffix}", "--inverse")


def test_openfoam(watched):
    foam_cases.write_case(watched.folder / "case", foam_cases.block(3, 3, 2))
    watched.ok("openfoam", "case")
