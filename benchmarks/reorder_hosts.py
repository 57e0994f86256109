#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Measures the time of `meshorder.reorder` for meshes of other libraries: for the order, and for moving mesh and data.

Usage: python benchmarks/reorder_hosts.py [edge]     with meshorder, PyVista and meshio installed

The mesh is a cube of edge³ cubes (65: 287,496 vertices), each cut into six tetrahedra, all shuffled, with two arrays on
its points and one on its cells.
"""

import pathlib
import statistics
import sys
import time

import meshio
import numpy as np
import pyvista

from meshorder.hosts import host_of

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "python" / "tests"))
from conftest import tetrahedra  # noqa: E402


def median_seconds(work, rounds=5):
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def main():
    points, cells = tetrahedra(int(sys.argv[1]) if len(sys.argv) > 1 else 65)
    random = np.random.default_rng(0)
    point_data = {"p": points[:, 0].copy(), "u": random.random((len(points), 3))}
    material = random.integers(5, size=len(cells))
    grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: cells}, points)
    grid.point_data.update(point_data)
    grid.cell_data["material"] = material
    foreign = meshio.Mesh(points, [("tetra", cells)], point_data=dict(point_data), cell_data={"material": [material]})
    tuples = (points, cells, point_data, {"material": material})
    print(f"{len(points):,} vertices, {len(cells):,} tetrahedra")
    for name, mesh in (("PyVista", grid), ("meshio", foreign), ("arrays", tuples)):
        for method in ("hilbert", "rcm", "fiedler"):
            host = host_of(mesh)
            order = host.order(method, "auto", {})
            ordering = median_seconds(lambda: host.order(method, "auto", {}))
            moving = median_seconds(lambda: host.moved(order, False))
            share = moving / (ordering + moving)
            print(f"{name:8} {method:8} order {ordering:.3f} s, moving {moving:.3f} s: {share:.0%} of the whole")


if __name__ == "__main__":
    main()
