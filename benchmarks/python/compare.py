# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Measures the cost of calls from Python, in turns with those of another library or of C++, and prints the ratios.

    cmake -B build -DMESHORDER_BENCHMARKS=ON && ninja -C build calls
    build/venv/bin/python benchmarks/python/compare.py build/bin/calls [--rounds 15] [--sizes 35 65] [--only PART]

Parts: `calls` with NumPy arrays against the same calls from C++, in time and in the growth of the process; `rcm`
against SciPy; `fiedler` against networkx; `import`, the time of importing meshorder. Meshes are shuffled cubes of SIZE³
lattice cells, six tetrahedra each: 35 makes 46,656 vertices, 65 makes 287,496. A ratio is that of the medians; the
quartiles of the ratios of single rounds follow it in brackets.
"""

from __future__ import annotations

import argparse
import ctypes
import gc
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial

import meshorder
import networkx as nx
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import reverse_cuthill_mckee

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "python" / "tests"))
from conftest import tetrahedra  # noqa: E402


def seconds(call: Callable[[], object]) -> float:
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def growth(call: Callable[[], object]) -> float:
    """Returns by how many bytes the process grows during the call; needs Linux with glibc."""

    def memory(key: str) -> int:
        with open("/proc/self/status") as file:
            return next(1024 * int(line.split()[1]) for line in file if line.startswith(key))

    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    pathlib.Path("/proc/self/clear_refs").write_text("5")
    before = memory("VmRSS")
    call()
    return memory("VmHWM") - before


def tell(what: str, ours: list[float], theirs: list[float], unit: str = "s") -> None:
    """Prints both medians, their ratio, and the quartiles of the ratios of single rounds."""
    middle = statistics.median(ours), statistics.median(theirs)
    ratios = [a / b for a, b in zip(ours, theirs)]
    quartiles = statistics.quantiles(ratios, n=4) if len(ratios) > 1 else ratios * 3
    print(
        f"{what:<44} {middle[0]:9.4g} {unit} / {middle[1]:9.4g} {unit} = {middle[0] / middle[1]:.4f}"
        f"  ({quartiles[0]:.3f} … {quartiles[2]:.3f})",
        flush=True,
    )


def in_turns(rounds: int, ours: Callable[[], float], theirs: Callable[[], float]) -> tuple[list[float], list[float]]:
    """Measures both sides in turns, each first in half of the rounds, after one round that is not counted."""
    measured: tuple[list[float], list[float]] = ([], [])
    for turn in range(rounds + 1):
        for side in (0, 1) if turn % 2 else (1, 0):
            value = (ours, theirs)[side]()
            if turn:
                measured[side].append(value)
    return measured


class Mesh:
    """Points, tetrahedra and the graph of a shuffled cube, in the types that are read in place."""

    def __init__(self, size: int) -> None:
        points, cells = tetrahedra(size)
        self.points: NDArray[np.float64] = np.ascontiguousarray(points, dtype=np.float64)
        self.cells: NDArray[np.int32] = np.ascontiguousarray(cells, dtype=np.int32)
        rows = np.concatenate([self.cells[:, i] for i in range(4) for j in range(4) if i != j])
        columns = np.concatenate([self.cells[:, j] for i in range(4) for j in range(4) if i != j])
        n = len(points)
        self.matrix = sp.coo_matrix((np.ones(len(rows), dtype=np.int32), (rows, columns)), shape=(n, n)).tocsr()
        self.matrix.sort_indices()
        self.offsets: NDArray[np.int64] = self.matrix.indptr.astype(np.int64)
        self.neighbours: NDArray[np.int32] = self.matrix.indices.astype(np.int32)


def compare_calls(program: str, mesh: Mesh, rounds: int) -> None:
    graph = mesh.offsets, mesh.neighbours
    calls: dict[str, Callable[[], object]] = {
        "rcm": lambda: meshorder.order(graph, "rcm", symmetric=True),
        "spectral": lambda: meshorder.order(graph, "spectral", symmetric=True),
        "fiedler": lambda: meshorder.fiedler(graph, symmetric=True),
        "order_mesh": lambda: meshorder.order_mesh(mesh.points, mesh.cells),
    }
    with tempfile.TemporaryDirectory() as folder:
        for name in ("offsets", "neighbours", "points", "cells"):
            getattr(mesh, name).tofile(pathlib.Path(folder) / name)
        with subprocess.Popen([program, folder], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:

            def ask(name: str, what: str) -> float:
                assert child.stdin is not None and child.stdout is not None
                print(name, what, file=child.stdin, flush=True)
                return float(child.stdout.readline())

            for name, call in calls.items():
                times = in_turns(rounds, partial(seconds, call), partial(ask, name, "TIME"))
                tell(f"{name}, Python / C++", *times)
                sizes = in_turns(3, partial(growth, call), partial(ask, name, "MEMORY"))
                tell(f"{name}, Python / C++, growth of the process", *sizes, unit="B")


def bandwidth(matrix: sp.csr_matrix, order: NDArray[np.int32]) -> int:
    moved = sp.coo_matrix(matrix[order][:, order])
    return int(np.abs(moved.row - moved.col).max())


def compare_rcm(mesh: Mesh, rounds: int) -> None:
    ours = meshorder.csgraph.reverse_cuthill_mckee
    calls = partial(reverse_cuthill_mckee, mesh.matrix, symmetric_mode=True), partial(ours, mesh.matrix, symmetric_mode=True)
    times = in_turns(rounds, partial(seconds, calls[0]), partial(seconds, calls[1]))
    tell("rcm, SciPy / meshorder", *times)
    found = [bandwidth(mesh.matrix, call()) for call in calls]
    print(f"  bandwidths: SciPy {found[0]}, meshorder {found[1]}")


def compare_fiedler(rounds: int) -> None:
    graphs = {
        "grid_2d_graph(30, 30)": nx.grid_2d_graph(30, 30),
        "grid_2d_graph(100, 100)": nx.grid_2d_graph(100, 100),
        "barbell_graph(60, 200)": nx.barbell_graph(60, 200),
        "random_geometric_graph(4000, 0.04)": nx.random_geometric_graph(4000, 0.04, seed=1),
    }
    for name, graph in graphs.items():
        if not nx.is_connected(graph):
            continue
        times = in_turns(
            min(rounds, 3),
            partial(seconds, partial(nx.fiedler_vector, graph, seed=1)),
            partial(seconds, partial(meshorder.networkx.fiedler_vector, graph, seed=1)),
        )
        tell(f"{name}, networkx / meshorder", *times)


def compare_import(rounds: int) -> None:
    def run(program: str) -> float:
        text = f"import time, numpy; t = time.perf_counter(); {program}; print(time.perf_counter() - t)"
        return float(subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True).stdout)

    ours, alone = in_turns(rounds, lambda: 1e3 * run("import meshorder"), lambda: 1e3 * run("pass"))
    print(f"import meshorder after NumPy: {statistics.median(ours) - statistics.median(alone):.1f} ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program that makes the calls from C++: build/bin/calls")
    parser.add_argument("--rounds", type=int, default=15, help="measurements of each side (default: %(default)s)")
    parser.add_argument("--sizes", type=int, nargs="+", default=[35, 65], help="lattice cells along a cube's side")
    parser.add_argument("--only", choices=["calls", "rcm", "fiedler", "import"], help="the part to run (default: all)")
    given = parser.parse_args()
    if given.only in (None, "calls", "rcm"):
        for size in given.sizes:
            mesh = Mesh(size)
            print(f"{len(mesh.points):,} vertices, {len(mesh.cells):,} tetrahedra")
            if given.only != "rcm":
                compare_calls(given.program, mesh, given.rounds)
            if given.only != "calls":
                compare_rcm(mesh, given.rounds)
    if given.only in (None, "fiedler"):
        compare_fiedler(given.rounds)
    if given.only in (None, "import"):
        compare_import(given.rounds)


if __name__ == "__main__":
    main()
