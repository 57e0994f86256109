#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares vertex orders by meshorder, SciPy, Boost, Scotch, METIS and meshoptimizer, with plain kernels.

Usage: orders.py MESH [--build DIR] [--rounds N] [--slow] [--more NAME=FILE…]

`peer-orders` and SciPy order the vertices of a tetrahedral mesh, each on one thread from a ready graph, and
`plain_kernels` times kernels without prefetches and blocking, as in simple programs, in all orders in turn. Prints for
each order its time and, for each kernel, the kernel's time divided by its time in the best order. `auto` is timed twice:
"auto again" shows how much two timings of the same order differ. The last columns are the mean and the largest of the
ratios: how much slower than the best order this one is. --more adds orders from elsewhere: .npy files with the old place
of the vertex at each new place. Debian's packages: libboost-graph-dev libscotch-dev libmeshoptimizer-dev.
"""
import argparse
import pathlib
import subprocess
import tempfile
import time

import numpy
import scipy.sparse
from scipy.sparse.csgraph import reverse_cuthill_mckee

OURS = ["auto", "bfs", "rcm", "hilbert-fronts", "hilbert", "spectral-fronts", "metis-nd"]
PEERS = ["boost-rcm", "scotch-nd", "meshopt-spatial"]
SLOW = ["boost-sloan"]  # a minute for 300,000 vertices


def scipys_order(folder):
    offsets, neighbours = (numpy.load(folder / f"{name}.npy") for name in ("offsets", "neighbours"))
    matrix = scipy.sparse.csr_matrix((numpy.ones(len(neighbours)), neighbours, offsets))
    begin = time.perf_counter()
    order = reverse_cuthill_mckee(matrix, symmetric_mode=True)
    seconds = time.perf_counter() - begin
    numpy.save(folder / "scipy-rcm.npy", order.astype(numpy.int32))
    return seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--more", nargs="*", default=[], metavar="NAME=FILE")
    parser.add_argument("--slow", action="store_true", help=f"and {', '.join(SLOW)}")
    arguments = parser.parse_args()
    peers = PEERS + SLOW * arguments.slow
    programs = arguments.build / "bin"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([programs / "peer-graph_of", arguments.mesh, folder], check=True)
        done = subprocess.run([programs / "peer-orders", arguments.mesh, folder, *OURS, *peers], check=True,
                              capture_output=True, text=True)
        seconds = {order: float(time) for order, time in (line.split() for line in done.stdout.splitlines())}
        seconds["scipy-rcm"] = scipys_order(folder)
        files = {order: folder / f"{order}.npy" for order in seconds}
        files["auto-again"] = files["auto"]
        files |= dict(more.split("=", 1) for more in arguments.more)
        methods = ",".join([*(f"{order}=@{file}" for order, file in files.items()), "original"])
        done = subprocess.run([programs / "plain_kernels", arguments.mesh, methods, str(arguments.rounds)], check=True,
                              capture_output=True, text=True)
    first, head, *rows = done.stdout.splitlines()
    kernels = head.split()[3:]
    table = {row.split()[0]: [float(x) for x in row.split()[1:]] for row in rows}
    best = numpy.array([times[2:] for times in table.values()]).min(axis=0)
    print(f"{first}\n\n| order | time | jump share | " + " | ".join(kernels) + " | mean | worst |")
    print("| --- |" + " ---: |" * (len(kernels) + 4))
    for order, (jumps, _, *times) in table.items():
        ratios = numpy.array(times) / best
        cost = f"{1e3 * seconds[order]:.0f} ms" if order in seconds else "–"
        print(f"| {order} | {cost} | {jumps:.3f} | " + " | ".join(f"{ratio:.2f}" for ratio in ratios)
              + f" | {ratios.mean():.2f} | {ratios.max():.2f} |")


if __name__ == "__main__":
    main()
