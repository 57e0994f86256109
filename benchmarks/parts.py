#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares the parts that `mpirun meshorder order` makes with METIS's, and the orders within them with the serial order.

    benchmarks/parts.py build/bin/meshorder ball-60.node torus-20.node --on 2:2 4:4 4:8 4:32

`--on RANKS:PARTS` names runs. The columns of the table, which goes to stdout in Markdown:

- mean log₂ span and mean span of the edges, divided by those of the serial order `spectral`;
- edges between parts, their number divided by METIS's, and the largest part divided by the mean. METIS, of pymetis, cuts
  k-way by its defaults. Its cut depends on the numbering of the vertices: the table takes the smaller cut of the file's
  order and of the order along Hilbert's curve;
- cache misses of the element force and of the matrix-vector product, predicted by `meshorder info` for caches of 32 KiB
  and 1 MiB, in all pieces of `--pieces OUT --ghosts 0` together and in the worst piece, relative to the misses of the same
  pieces in the serial order. There, a piece has its own vertices first and then the ghosts of each owner; the vertices of
  each such group are in the serial order, and cells in `lexmax`, which ranks ghosts before own vertices, as in the
  pieces. A dash: the caches hold every piece.

Meshes have tetrahedra and one component. Needs NumPy, meshio, pymetis and peer-graph_of (MESHORDER_BENCHMARKS).
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

import meshio
import numpy
import pymetis

CACHES = ["32K", "1M"]
KERNELS = ["element", "spmv"]
HEADER = ["mesh", "parts", "mean log₂ span", "mean span", "cut", "cut over METIS k-way", "imbalance",
          "element force: L1, L2", "worst piece", "product: L1, L2", "worst piece"]


def run(*command):
    """Returns what a command prints."""
    return subprocess.run(list(map(str, command)), check=True, stdout=subprocess.PIPE, text=True,
                          env={**os.environ, "OMPI_MCA_mpi_yield_when_idle": "1"}).stdout


class Mesh:
    """A mesh in its own order and in the serial one, and its graph."""

    def __init__(self, options, path, folder):
        self.options, self.path, self.folder = options, path, folder
        folder.mkdir()
        maps = folder / "serial"
        self.spans = json.loads(run(options.program, "order", path, "-o", folder / "serial.vtu", "--vertices", "spectral", "--maps", maps,
                                    "--json", "-q"))["edge_span"]["after"]
        self.serial = numpy.load(f"{maps}.vertices.old_to_new.npy").astype(numpy.int64)
        along_curve = folder / "along-curve.vtu"
        run(options.program, "order", path, "-o", along_curve, "--vertices", "hilbert", "-q")
        self.graphs = [self.graph_of(path), self.graph_of(along_curve)]

    def graph_of(self, path):
        run(self.options.program.parent / "peer-graph_of", path, self.folder)
        return pymetis.CSRAdjacency(*(numpy.load(self.folder / f"{name}.npy").astype(numpy.int64) for name in ("offsets", "neighbours")))

    def metis_cut(self, parts):
        return min(pymetis.part_graph(parts, graph)[0] for graph in self.graphs)

    def misses(self, piece):
        """Returns the misses of each kernel and cache."""
        report = run(self.options.program, "info", piece, "--json", "--cache", ",".join(CACHES), "--machine", "zen3", "-q")
        return [json.loads(report)["reuse"][kernel]["misses"] for kernel in KERNELS]

    def in_serial_order(self, piece, new_to_old):
        """Writes the piece with its vertices in the serial order and its cells in `lexmax`; returns the path."""
        data = meshio.read(piece)
        owner = data.point_data["part"].astype(numpy.int64)
        is_ghost = data.point_data["vtkGhostType"].astype(numpy.int64)
        place = self.serial[new_to_old[data.point_data["GlobalPointIds"].astype(numpy.int64)]]
        old = numpy.lexsort((place, owner, is_ghost))
        new = numpy.empty_like(old)
        new[old] = numpy.arange(len(old))
        cells = data.cells_dict["tetra"]
        ends = numpy.sort((new - len(new) * is_ghost)[cells], axis=1)
        moved = self.folder / "moved.vtu"
        meshio.write(moved, meshio.Mesh(data.points[old], [("tetra", new[cells[numpy.lexsort(ends.T)]])]), compression=None)
        return moved

    def row(self, ranks, parts):
        pieces, maps = self.folder / f"pieces-{ranks}-{parts}", self.folder / "maps"
        report = json.loads(run(*self.options.mpirun.split(), "-n", ranks, self.options.program, "order", self.path, "-o",
                                self.folder / "ordered.vtu", "--parts", parts, "--pieces", pieces, "--ghosts", 0, "--maps", maps,
                                "--threads", 1, "--json", "-q"))
        new_to_old = numpy.load(f"{maps}.vertices.new_to_old.npy").astype(numpy.int64)
        files = sorted(pieces.glob("*.vtu"))
        ours = numpy.array([self.misses(piece) for piece in files], dtype=float)
        serial = numpy.array([self.misses(self.in_serial_order(piece, new_to_old)) for piece in files], dtype=float)
        spans, partition = report["edge_span"]["after"], report["partition"]
        cells = [self.path.stem, f"{parts}", *(f"{spans[key] / self.spans[key]:.3f}" for key in ("mean_log2", "mean")),
                 f"{partition['cut']:,}", f"{partition['cut'] / self.metis_cut(parts):.3f}", f"{partition['imbalance']:.3f}"]
        for kernel in range(len(KERNELS)):
            missed = serial[:, kernel] > 0  # by a cache that does not hold the piece
            worst = numpy.where(missed, ours[:, kernel] / numpy.where(missed, serial[:, kernel], 1), 0).max(0)
            summed = ours[:, kernel].sum(0), serial[:, kernel].sum(0)
            cells.append(", ".join(f"{o / s:.3f}" if s else "–" for o, s in zip(*summed)))
            cells.append(", ".join(f"{ratio:.3f}" if ratio else "–" for ratio in worst))
        return f"| {' | '.join(cells)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda path: pathlib.Path(path).resolve(), help="build/bin/meshorder, with peer-graph_of beside it")
    parser.add_argument("meshes", type=pathlib.Path, nargs="+")
    parser.add_argument("--on", nargs="+", default=["2:2", "4:4", "4:8", "4:32"], metavar="RANKS:PARTS")
    parser.add_argument("--mpirun", default="mpirun --oversubscribe", help="what starts ranks")
    options = parser.parse_args()
    print(f"| {' | '.join(HEADER)} |\n| --- |{' ---: |' * (len(HEADER) - 1)}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for path in options.meshes:
            mesh = Mesh(options, path, pathlib.Path(folder) / path.stem)
            for ranks, parts in (map(int, on.split(":")) for on in options.on):
                print(mesh.row(ranks, parts), flush=True)


if __name__ == "__main__":
    main()
