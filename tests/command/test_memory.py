# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The memory for reading and writing a mesh, relative to the size of its file."""
import os
import subprocess
import sys

import meshio
import pytest
from conftest import MESHORDER
from test_cgns import box

# peak memory less that of a mesh of few cells, divided by the size of the file
MOST = {"cgns": 6.0, "med": 6.0, "vtkhdf": 6.0, "xdmf": 5.0, "exo": 5.0, "vtu": 5.0, "su2": 5.0, "inp": 4.0, "bdf": 5.0, "unv": 3.0}


# a small process starts the command: the system's figure of a child's peak includes that of its parent at the start
RUNNER = """import os, sys
_, status, usage = os.wait4(os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ), 0)
print(status, usage.ru_maxrss)"""


def peak_and_status(folder, *arguments):
    """The exit status of a run of the command, its peak memory in bytes, and its errors."""
    done = subprocess.run([sys.executable, "-S", "-c", RUNNER, MESHORDER, *map(str, arguments)], cwd=folder,
                          capture_output=True, text=True, check=True)
    status, most = map(int, done.stdout.split()[-2:])
    return os.waitstatus_to_exitcode(status), most * 1024, done.stderr


def peak(*arguments):
    """The peak memory of a run of the command, in bytes."""
    status, most, error = peak_and_status(None, *arguments)
    assert status == 0, error
    return most


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    """A mesh of few cells and one of 162,000."""
    folder = tmp_path_factory.mktemp("meshes")
    for name, n in (("few", 2), ("many", 30)):
        points, tetrahedra, _ = box(n, 1)
        meshio.write(folder / f"{name}.vtu", meshio.Mesh(points, [("tetra", tetrahedra)]), compression=None)
    return folder


@pytest.mark.skipif("ASAN_OPTIONS" in os.environ, reason="sanitizers take memory of their own")
@pytest.mark.parametrize("extension", MOST)
def test_memory_is_proportional_to_the_file(meshes, tmp_path, extension):
    peaks = []
    for name in ("few", "many"):
        keep = ("--vertices", "original", "--elements", "original")
        peak("order", meshes / f"{name}.vtu", "-o", tmp_path / f"{name}.{extension}", *keep)
        (tmp_path / "b").mkdir(exist_ok=True)
        peaks.append(peak("order", tmp_path / f"{name}.{extension}", "-o", tmp_path / f"b/{name}.{extension}", *keep))
    size = sum(path.stat().st_size for path in tmp_path.glob("many.*"))
    assert (peaks[1] - peaks[0]) / size < MOST[extension]
