# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares the counts of `meshorder.gpu_cost` and `gpu_product_cost` with a GPU's counters.

    python gpu_counts.py MESH FOLDER

MESH is a mesh of tetrahedra that was measured, in its file's order; FOLDER has `ncu_order.txt`, a line for each launch (mesh,
order and kernel, with tabs between), and `ncu_MESH.csv`, Nsight Compute's counters of these launches. Orders are
named vertices/elements and are computed again here; random ones are left out. Prints a table, and the median and largest
deviation of sectors and of bytes.
"""

import csv
import functools
import pathlib
import statistics
import sys

import meshorder
import numpy as np

LOADS = "l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum"
ADDITIONS = "l1tex__t_sectors_pipe_lsu_mem_global_op_red.sum"
READ = "dram__bytes_read.sum"
REST = 40  # bytes of other data that a kernel reads for each tetrahedron
LENGTH = 4  # bytes of other data that a kernel reads for each spring


class Ordered:
    """Tetrahedra in an order. The functions return, for a kernel, the counter to compare, the sectors, and the bytes.
    `stored` is the number of each vertex in the mesh as it was stored for the measurement."""

    def __init__(self, cells, vertices, stored):
        self.cells, self.vertices, self.stored = cells, vertices, stored

    @functools.cached_property
    def graph(self):
        pairs = np.concatenate([self.cells[:, [a, b]] for a in range(4) for b in range(4) if a != b]).astype(np.int64)
        rows, columns = np.divmod(np.unique(pairs[:, 0] * self.vertices + pairs[:, 1]), self.vertices)
        return np.searchsorted(rows, np.arange(self.vertices + 1)), columns.astype(np.int32)

    @functools.cached_property
    def springs(self):
        offsets, columns = self.graph
        rows = np.repeat(np.arange(self.vertices, dtype=columns.dtype), np.diff(offsets))
        springs = np.column_stack((rows, columns))[columns < rows]  # by the larger end, as lexmax has them
        # the first end was chosen by the stored numbers, before the order was made
        return np.where((self.stored[springs[:, 0]] > self.stored[springs[:, 1]])[:, None], springs[:, ::-1], springs)

    def of_cells(self, layout):
        cost = meshorder.gpu_cost(self.cells, layout)
        return ADDITIONS, cost.sectors, cost.dram_bytes + REST * len(self.cells)

    def of_springs(self, layout):
        cost = meshorder.gpu_cost(self.springs, layout)
        return ADDITIONS, cost.sectors, cost.dram_bytes + LENGTH * len(self.springs)

    def of_gathering(self):
        """Returns the loads of the second pass: without the sectors and the bytes of the first pass."""
        cost = meshorder.gpu_cost(self.cells, "gathered")
        return LOADS, cost.sectors - 2 * len(self.cells), cost.dram_bytes - 16 * len(self.cells) - 12 * self.vertices

    def of_product(self, lanes):
        cost = meshorder.gpu_product_cost(self.graph, lanes)
        return LOADS, cost.sectors, cost.dram_bytes


KERNELS = {
    "force_aos3": lambda of: of.of_cells("packed"),
    "force_soa": lambda of: of.of_cells("apart"),
    "force_vec4": lambda of: of.of_cells("padded"),
    "force_patch": lambda of: of.of_cells("patches"),
    "sum_corners": lambda of: of.of_gathering(),
    "spring_aos3": lambda of: of.of_springs("packed"),
    "spring_vec4": lambda of: of.of_springs("padded"),
    "csr_scalar": lambda of: of.of_product(1),
    "csr_vec8": lambda of: of.of_product(8),
}


def launches(folder):
    """Yields the order, the kernel and the counters of each launch."""
    lines = [line.split("\t") for line in (folder / "ncu_order.txt").read_text().splitlines()]
    with open(folder / f"ncu_{lines[0][0]}.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["ID"]]
    for (_, order, kernel), row in zip(lines, rows, strict=True):
        yield order, kernel, {name: int(row[name].replace(",", "")) for name in (LOADS, ADDITIONS, READ)}


def summary(deviations):
    sizes = [abs(deviation) for deviation in deviations]
    return f"median {statistics.median(sizes):.2%}, largest {max(sizes):.2%} of {len(sizes)}"


def main():
    mesh = meshorder.read(sys.argv[1])
    folder = pathlib.Path(sys.argv[2])
    given = mesh.connectivity.reshape(len(mesh.shapes), -1)
    stored = meshorder.order_mesh(mesh.points, given, vertices="hilbert", elements="original").vertices.permutation.old_to_new

    @functools.lru_cache(maxsize=1)
    def ordered(order):
        found = meshorder.order_mesh(mesh.points, given, **dict(zip(("vertices", "elements"), order.split("/"))))
        vertices = found.vertices.permutation
        return Ordered(found.cells.permutation.move(vertices.renumber(given)), len(mesh.points), vertices.move(stored))

    sectors, read = [], []
    print("| order | kernel | sectors | counted | deviation | MB read | counted | deviation |")
    print("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    for order, kernel, counters in launches(folder):
        springs_as_in_file = kernel.startswith("spring") and "+edges" in order
        if kernel not in KERNELS or "scrambled" in order or springs_as_in_file:
            continue
        counter, counted, bytes_read = KERNELS[kernel](ordered(order.partition("+edges")[0]))
        sectors.append(counted / counters[counter] - 1)
        read.append(bytes_read / counters[READ] - 1)
        print(f"| {order} | {kernel} | {counters[counter]:,} | {counted:,} | {sectors[-1]:+.2%} "
              f"| {counters[READ] / 1e6:.1f} | {bytes_read / 1e6:.1f} | {read[-1]:+.1%} |", flush=True)  # fmt: skip
    print(f"\nsectors: {summary(sectors)}\nbytes: {summary(read)}")


if __name__ == "__main__":
    main()
