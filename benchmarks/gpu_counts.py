# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares the sectors that `meshorder.gpu_cost` counts with those that a GPU's counters had.

    python gpu_counts.py MESH FOLDER

MESH is the mesh that was measured, in its file's order; FOLDER has `ncu_order.txt`, a line for each launch (mesh, order and
kernel, with tabs between), and `ncu_MESH.csv`, what Nsight Compute counted in them. Orders are named vertices/elements, and are
made anew here; random ones are left out. Prints a table and the largest deviation.
"""

import csv
import pathlib
import sys

import meshorder

LAYOUTS = {"force_aos3": "packed", "force_soa": "apart", "force_vec4": "padded"}
COUNTER = "l1tex__t_sectors_pipe_lsu_mem_global_op_red.sum"


def measured(folder):
    """Yields the order, the layout and the sectors of each launch."""
    launches = [line.split("\t") for line in (folder / "ncu_order.txt").read_text().splitlines()]
    name = launches[0][0]
    with open(folder / f"ncu_{name}.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["ID"]]
    for (_, order, kernel), row in zip(launches, rows, strict=True):
        if kernel in LAYOUTS and "scrambled" not in order:
            yield order.partition("+edges")[0], LAYOUTS[kernel], int(row[COUNTER].replace(",", ""))


def main():
    mesh = meshorder.read(sys.argv[1])
    given = mesh.connectivity.reshape(len(mesh.shapes), -1)
    worst, name, cells = 0.0, "", given
    print("| order | layout | measured | counted | deviation |\n| --- | --- | ---: | ---: | ---: |")
    for order, layout, sectors in measured(pathlib.Path(sys.argv[2])):
        if order != name:
            found = meshorder.order_mesh(mesh.points, given, **dict(zip(("vertices", "elements"), order.split("/"))))
            cells = found.cells.permutation.move(found.vertices.permutation.renumber(given))
            name = order
        counted = meshorder.gpu_cost(cells, layout).sectors
        deviation = counted / sectors - 1
        worst = max(worst, abs(deviation))
        print(f"| {order} | {layout} | {sectors:,} | {counted:,} | {deviation:+.2%} |")
    print(f"\nlargest deviation {worst:.2%}")


if __name__ == "__main__":
    main()
