# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Fits the times of kernels on a GPU to the counts of `meshorder.gpu_cost`: the constants of `meshorder info --gpu --card`.

    python gpu_card.py RESULTS NAME=MESH …

RESULTS has a record of JSON for each mesh, order and kernel that was measured, with the median time `warm` in µs. Each MESH is
one of these meshes, of tetrahedra, in its file's order. The orders, vertices/elements, are computed again; orders that meshorder
does not make are left out. The model of a kernel's time: launch + √(s² + b²), with a time s for sectors, and a time b for bytes
that memory reads more than once.

The times of a launch and of a sector are fitted without b and without random orders. For each mesh, prints these two times
fitted to the other meshes, and how well they predict this mesh: the median and the largest error of a time; the rank correlation
of all orders and layouts; and for each layout the regret: how much slower the order predicted to be the fastest is than the
fastest order. Then come the two times fitted to all meshes. Last comes the time of a byte, fitted to all orders of the meshes
that are too large for the cache, and the errors of this model for all of their orders.
"""

import json
import sys

import meshorder
import numpy as np

KERNELS = {"force_aos3": "packed", "force_soa": "apart", "force_vec4": "padded"}


def times_of(path):
    """Returns the time of each order and layout for each mesh."""
    times = {}
    with open(path, encoding="utf-8") as file:
        for record in map(json.loads, file):
            order = record["order"].partition("+edges")[0]
            if record["kernel"] in KERNELS and "warm" in record and "+" not in order:
                times.setdefault(record["mesh"], {}).setdefault(order, {})[KERNELS[record["kernel"]]] = record["warm"]
    return times


def counts_of(mesh, orders):
    """Yields each order that meshorder makes and, by layout, its sectors and the bytes that are read more than once."""
    given = mesh.connectivity.reshape(len(mesh.shapes), -1)
    known = {method.name for method in meshorder.methods()}
    for order in orders:
        vertices, elements = order.split("/")
        if vertices not in known:
            continue
        found = meshorder.order_mesh(mesh.points, given, vertices=vertices, elements=elements)
        cells = found.cells.permutation.move(found.vertices.permutation.renumber(given))
        costs = {layout: meshorder.gpu_cost(cells, layout) for layout in KERNELS.values()}
        yield order, {layout: (cost.sectors, max(cost.dram_bytes - cost.dram_floor, 0)) for layout, cost in costs.items()}


def fitted(pairs):
    """Fits the times of a launch and of a sector to pairs of sectors and times, by least squares of relative errors."""
    sectors, times = np.array(pairs).T
    return np.linalg.lstsq(np.column_stack((1 / times, sectors / times)), np.ones(len(times)), rcond=None)[0]


def fitted_bytes(launch, per_sector, triples):
    """Fits the time of a byte to sectors, bytes and times, and returns it with the relative errors of all times."""
    sectors, again, times = np.array(triples).T
    errors = {ps: (launch + np.hypot(per_sector * sectors, 1e-6 * ps * again)) / times - 1 for ps in np.arange(0, 5, 0.01)}
    return min(errors.items(), key=lambda found: (found[1] ** 2).sum())


def in_words(launch, per_sector):
    return f"{launch:.2f} µs + {1e6 * per_sector:.2f} ps a sector"


def rank_correlation(a, b):
    return np.corrcoef(*(np.argsort(np.argsort(values)) for values in (a, b)))[0, 1]


def report(name, of_layout, others):
    """Prints how well the times of launches and sectors of other meshes predict this one."""
    launch, per_sector = fitted(others)
    sectors, times = np.array([pair for pairs in of_layout.values() for pair in pairs]).T
    errors = abs((launch + per_sector * sectors) / times - 1)
    rank = rank_correlation(sectors, times)
    print(f"{name}: {in_words(launch, per_sector)} by the others; error of {len(errors)} times: "
          f"median {np.median(errors):.1%}, largest {errors.max():.1%}; rank correlation {rank:.2f}")  # fmt: skip
    for layout, pairs in of_layout.items():
        sectors, times = np.array(pairs).T
        print(f"  {layout}: regret {times[sectors.argmin()] / times.min() - 1:.1%}")


def main():
    times = times_of(sys.argv[1])
    counted = {}
    large = []
    for word in sys.argv[2:]:
        name, _, path = word.partition("=")
        counted[name] = {layout: [] for layout in KERNELS.values()}
        triples = []
        for order, counts in counts_of(meshorder.read(path), times[name]):
            for layout, time in times[name][order].items():
                triples.append((*counts[layout], time))
                if "scrambled" not in order:
                    counted[name][layout].append((counts[layout][0], time))
        if any(again > 0 for _, again, _ in triples):
            large += triples
    flat = {name: [pair for pairs in of_layout.values() for pair in pairs] for name, of_layout in counted.items()}
    for name, of_layout in counted.items():
        report(name, of_layout, [pair for other, pairs in flat.items() if other != name for pair in pairs])
    both = fitted([pair for pairs in flat.values() for pair in pairs])
    print(f"all: {in_words(*both)}")
    if large:
        per_byte, errors = fitted_bytes(*both, large)
        print(f"large meshes: {per_byte:.2f} ps a byte; errors {errors.min():+.1%} to {errors.max():+.1%}")


if __name__ == "__main__":
    main()
