# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares the costs of reading and writing files with those of meshio and of the formats' own copy tools, in one run that
measures both sides in turns.

    build/venv/bin/python benchmarks/formats.py [--size 50] [--rounds 5] [--only xdmf-text msh …]

The mesh is a cube of SIZE³ lattice cells, six tetrahedra each, shuffled, with an array of three numbers on its vertices and
one on its cells: 50 makes 132,651 vertices and 750,000 tetrahedra. Times are processor time of the whole process, user and
system, so that other work on the machine matters little. A ratio is that of the medians; it is above 1 where meshorder is
faster.
"""

from __future__ import annotations

import argparse
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable

import meshio
import meshorder
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "python" / "tests"))
from conftest import tetrahedra  # noqa: E402

# meshio's name of a format, and its options for the kind of file that meshorder writes, or the nearest one
KINDS: dict[str, tuple[str, str, dict[str, object]]] = {
    "msh": (".msh", "gmsh", {"binary": False}),
    "msh-binary": (".msh", "gmsh", {"binary": True}),
    "vtu": (".vtu", "vtu", {"compression": "zlib"}),
    "vtu-raw": (".vtu", "vtu", {"compression": None}),
    "vtk": (".vtk", "vtk", {"binary": True}),
    "medit": (".mesh", "medit", {}),
    "su2": (".su2", "su2", {}),
    "abaqus": (".inp", "abaqus", {}),
    "exodus": (".e", "exodus", {}),
    "xdmf": (".xdmf", "xdmf", {"data_format": "HDF", "compression": None}),
    "xdmf-gzip": (".xdmf", "xdmf", {"data_format": "HDF"}),
    "xdmf-text": (".xdmf", "xdmf", {"data_format": "XML"}),
    "nastran": (".bdf", "nastran", {}),
    "med": (".med", "med", {}),
}
COPIES = {
    "exodus": (["nccopy"], ".e"),
    "xdmf": (["h5repack"], ".h5"),
    "xdmf-gzip": (["h5repack", "-f", "GZIP=4"], ".h5"),  # without this it copies compressed data as it is
    "med": (["h5repack"], ".med"),
}


def processor_seconds(call: Callable[[], object], who: int = resource.RUSAGE_SELF) -> float:
    before = resource.getrusage(who)
    call()
    after = resource.getrusage(who)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def example(size: int) -> meshio.Mesh:
    points, cells = tetrahedra(size)
    values = np.sin(points)
    return meshio.Mesh(points, [("tetra", cells)], {"u": values}, {"pressure": [values[cells].sum(axis=(1, 2))]})


def measure(name: str, mesh: meshio.Mesh, rounds: int, folder: pathlib.Path) -> None:
    suffix, kind, options = KINDS[name]
    theirs, ours = folder / ("theirs" + suffix), folder / ("ours" + suffix)
    if name == "msh":  # with NumPy 2, meshio 5.3.5 writes "np.float64(…)" for numbers
        meshorder.write(mesh, theirs)
    else:
        meshio.write(theirs, mesh, kind, **options)
    read = meshorder.read(theirs)
    sides: dict[str, tuple[Callable[[], object], int]] = {
        "reading": (lambda: meshorder.read(theirs), resource.RUSAGE_SELF),
        "reading by meshio": (lambda: meshio.read(theirs, kind), resource.RUSAGE_SELF),
        "writing": (lambda: meshorder.write(read, ours), resource.RUSAGE_SELF),
        "writing by meshio": (lambda: meshio.write(folder / ("again" + suffix), mesh, kind, **options), resource.RUSAGE_SELF),
    }
    tool, copied = COPIES.get(name, ([""], ""))
    if tool[0] and shutil.which(tool[0]):
        command = [*tool, theirs.with_suffix(copied), folder / "copy"]
        sides["copy"] = (lambda: subprocess.run(command, check=True), resource.RUSAGE_CHILDREN)
    seconds: dict[str, list[float]] = {side: [] for side in sides}
    for turn in range(rounds + 1):
        for side in sorted(sides, reverse=turn % 2 == 1):
            call, who = sides[side]
            taken = processor_seconds(call, who)
            if turn:
                seconds[side].append(taken)
    median = {side: statistics.median(values) for side, values in seconds.items()}
    size = sum(path.stat().st_size for path in folder.glob("theirs*"))
    line = f"{name:<12}{size / 1e6:8.1f} MB"
    for side in ("reading", "writing"):
        line += f"   {side} {1e3 * median[side]:7.1f} ms, meshio {1e3 * median[side + ' by meshio']:8.1f} ms"
        line += f" = {median[side + ' by meshio'] / median[side]:5.1f}"
    if "copy" in median:
        line += f"   both over {tool[0]} {(median['reading'] + median['writing']) / median['copy']:.2f}"
    print(line, flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=50)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--only", nargs="+", choices=KINDS, default=list(KINDS))
    arguments = parser.parse_args()
    mesh = example(arguments.size)
    for name in arguments.only:
        with tempfile.TemporaryDirectory() as folder:
            try:
                measure(name, mesh, arguments.rounds, pathlib.Path(folder))
            except meshorder.Unavailable as lacking:
                print(f"{name:<12} {lacking}")


if __name__ == "__main__":
    main()
