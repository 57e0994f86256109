# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Fits the times of kernels on a GPU to the counts of `meshorder.gpu_cost`: the constants of `meshorder info --gpu --card`.

    python gpu_card.py RESULTS NAME=MESH …

RESULTS has a record of JSON for each mesh, order and kernel that was measured, with the median time `warm` in µs. Each MESH is
one of these meshes, of tetrahedra, in its file's order. The orders, vertices/elements, are computed again; random orders and
orders that meshorder does not make are left out. The model of a kernel's time: one time for its launch, and one for each sector.
For each mesh, prints these two times fitted to the other meshes, and how well they predict this mesh: the median and the largest
error of a time; the rank correlation of all orders and layouts; and for each layout the regret: how much slower the order
predicted to be the fastest is than the fastest order. Last come the two times fitted to all meshes.
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
            if record["kernel"] in KERNELS and "warm" in record and "+" not in order and "scrambled" not in order:
                times.setdefault(record["mesh"], {}).setdefault(order, {})[KERNELS[record["kernel"]]] = record["warm"]
    return times


def sectors_of(mesh, orders):
    """Yields the sectors of each layout for each of the orders that meshorder makes."""
    given = mesh.connectivity.reshape(len(mesh.shapes), -1)
    known = {method.name for method in meshorder.methods()}
    for order in orders:
        vertices, elements = order.split("/")
        if vertices not in known:
            continue
        found = meshorder.order_mesh(mesh.points, given, vertices=vertices, elements=elements)
        cells = found.cells.permutation.move(found.vertices.permutation.renumber(given))
        yield order, {layout: meshorder.gpu_cost(cells, layout).sectors for layout in KERNELS.values()}


def fitted(pairs):
    """Fits the times of a launch and of a sector to pairs of sectors and times, by least squares of relative errors."""
    sectors, times = np.array(pairs).T
    return np.linalg.lstsq(np.column_stack((1 / times, sectors / times)), np.ones(len(times)), rcond=None)[0]


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
    for word in sys.argv[2:]:
        name, _, path = word.partition("=")
        counted[name] = {layout: [] for layout in KERNELS.values()}
        for order, sectors in sectors_of(meshorder.read(path), times[name]):
            for layout, time in times[name][order].items():
                counted[name][layout].append((sectors[layout], time))
    flat = {name: [pair for pairs in of_layout.values() for pair in pairs] for name, of_layout in counted.items()}
    for name, of_layout in counted.items():
        report(name, of_layout, [pair for other, pairs in flat.items() if other != name for pair in pairs])
    print(f"all: {in_words(*fitted([pair for pairs in flat.values() for pair in pairs]))}")


if __name__ == "__main__":
    main()
