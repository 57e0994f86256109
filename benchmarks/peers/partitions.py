#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares the parts and orders that meshorder makes on several ranks with those of Sphynx, METIS, DOLFINx and parRSB.

    benchmarks/peers/partitions.py build/bin/meshorder dragon.node ball-60.node --ranks 4 --parts 4 32
    benchmarks/peers/partitions.py build/bin/meshorder --hexahedra 60 40 30 --ranks 2 8

The first partitions the vertex graph of each mesh. All begin with the vertices in Hilbert's order, each rank with a range of it. Sphynx,
of Trilinos' Zoltan2, runs with each of its preconditioners; METIS, of pymetis, is serial. DOLFINx cuts elements by PT-Scotch into as many
parts as ranks, and numbers the vertices within each; its table shows whole pipelines, from elements and points to new numbers.
The second partitions a box of hexahedra, because parRSB, of Nek5000, takes only hexahedra: the graph joins elements with a
common face.

"cut" counts edges between parts; "imbalance" is the largest part divided by the mean. Seconds are processor time in user mode of
all ranks together, waiting included, medians of --rounds runs that take turns. They count the partitioner alone, without
reading, and meshorder's stage of that name, in steps of 10 ms (see ranks.py).

Debian's packages: trilinos-all-dev for Sphynx, python3-dolfinx, and for parRSB its library and gslib's, built from their
sources:

    cmake -B build -DMESHORDER_BENCHMARKS=ON -DMESHORDER_MPI=ON "-DCMAKE_PREFIX_PATH=PARRSB/install;GSLIB/build"

Peers that are missing are skipped with a message.
"""
import argparse
import importlib.util
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import meshio
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from ranks import STAGES, WAITING, run_watched

PIPELINE = STAGES[1:-1]  # from a mesh in memory to a numbered one
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", **WAITING}
SPHYNX = ["muelu", "jacobi", "polynomial"]


class Missing(Exception):
    """Something that a peer needs is not on this machine."""


class Problem:
    """A graph as rows, for all peers alike, and the mesh that meshorder reads."""

    def __init__(self, mesh, folder):
        self.mesh, self.folder = mesh, folder
        offsets, self.to = (numpy.load(folder / f"{name}.npy").astype(numpy.int64) for name in ("offsets", "neighbours"))
        self.offsets = offsets
        self.of = numpy.repeat(numpy.arange(len(offsets) - 1), numpy.diff(offsets))
        self.size = len(offsets) - 1

    def judged(self, parts):
        cut = int((parts[self.of] != parts[self.to]).sum()) // 2
        sizes = numpy.bincount(parts)
        return {"cut": cut, "imbalance": sizes.max() / sizes.mean()}

    def spans(self, numbers):
        """Mean log2 span and mean span of the edges."""
        spans = numpy.abs(numbers[self.of] - numbers[self.to])
        return {"log2": numpy.log2(spans).mean(), "span": spans.mean()}


def output_of(command):
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **ONE_THREAD})
    if done.returncode != 0:
        raise Missing((done.stderr.split("-----")[0].strip().splitlines() or [f"exit status {done.returncode}"])[-1])
    return float(done.stdout.split()[-1])


def by_program(options, name, source, problem, ranks, parts, more=()):
    program = options.program.parent / f"peer-{name}"
    if not program.exists():
        raise Missing("not built, its library is missing")
    result = problem.folder / "parts.npy"
    seconds = output_of([*options.mpirun.split(), "-n", str(ranks), program, source, str(parts), result, *more])
    return {"seconds": seconds, **problem.judged(numpy.load(result))}


def by_metis(problem, parts):
    if not importlib.util.find_spec("pymetis"):
        raise Missing("pymetis is missing")
    import pymetis
    before = os.times().user
    result = pymetis.part_graph(parts, pymetis.CSRAdjacency(problem.offsets, problem.to))[1]
    return {"seconds": os.times().user - before, **problem.judged(numpy.array(result))}


def by_meshorder(options, problem, ranks, parts, partition):
    maps = problem.folder / "maps"
    command = [*options.mpirun.split(), "-n", str(ranks), options.program, "order", problem.mesh, "-o",
               problem.folder / "ordered.vtu", "--maps", maps, "--partition", partition, "--parts", str(parts), "--threads",
               "1", "--json", "-q"]
    report, watch, came, _ = run_watched(command, True)
    stages = [stage for stage in STAGES if stage in report["seconds"]]
    ends = came - numpy.cumsum([0.0, *(report["seconds"][stage] for stage in reversed(stages))])[::-1]
    spent = dict(zip(stages, watch.between(ends)[0].sum(0)))
    numbers = numpy.load(f"{maps}.vertices.old_to_new.npy").astype(numpy.int64)
    return {"seconds": spent.get("partition", 0.0), "pipeline": sum(spent[stage] for stage in PIPELINE if stage in spent),
            **problem.judged(numpy.load(f"{maps}.vertices.parts.npy")[numbers]), **problem.spans(numbers)}


def by_dolfinx(options, problem, ranks):
    program = pathlib.Path(__file__).with_name("dolfinx_mesh.py")
    seconds = output_of([*options.mpirun.split(), "-n", str(ranks), sys.executable, program, problem.folder, problem.folder])
    numbers, starts = (numpy.load(problem.folder / f"{name}.npy") for name in ("numbers", "starts"))
    parts = numpy.searchsorted(starts, numbers, side="right") - 1
    return {"pipeline": seconds, **problem.judged(parts), **problem.spans(numbers)}


def measured(options, peers):
    """Runs all peers in turn, round by round; returns for each the medians of its results."""
    results, failures = {name: [] for name in peers}, {}
    for _ in range(options.rounds):
        for name, run in peers.items():
            if name in failures:
                continue
            try:
                results[name].append(run())
            except Missing as missing:
                failures[name] = missing
                print(f"{name}: {missing}", file=sys.stderr)
    told = {}
    for name, runs in results.items():
        if runs:
            told[name] = {key: statistics.median(run[key] for run in runs) for key in runs[0]}
    return told


def print_parts(title, told):
    print(f"\n{title}\n\n| by | cut | imbalance | processor seconds |\n| --- | ---: | ---: | ---: |")
    for name, values in told.items():
        if "seconds" in values:
            print(f"| {name} | {values['cut']:,.0f} | {values['imbalance']:.3f} | {values['seconds']:.2f} |")


def print_pipelines(title, told):
    print(f"\n{title}\n\n| by | cut | imbalance | mean log₂ span | mean span | processor seconds |\n"
          "| --- | ---: | ---: | ---: | ---: | ---: |")
    for name, values in told.items():
        if "pipeline" in values:
            print(f"| {name} | {values['cut']:,.0f} | {values['imbalance']:.3f} | {values['log2']:.3f} | {values['span']:,.0f} | "
                  f"{values['pipeline']:.2f} |")


def mesh_problem(options, mesh, folder):
    """The vertex graph of a mesh in Hilbert's order, its tetrahedra and points."""
    folder.mkdir()
    ordered = folder / "mesh.vtu"
    subprocess.run([options.program, "order", mesh, "-o", ordered, "--vertices", "hilbert", "-q"], check=True)
    subprocess.run([options.program.parent / "peer-graph_of", ordered, folder], check=True)
    data = meshio.read(ordered)
    numpy.save(folder / "points.npy", data.points)
    numpy.save(folder / "tetrahedra.npy", data.cells_dict["tetra"].astype(numpy.int64))
    return Problem(ordered, folder)


def box_problem(sides, folder):
    """Hexahedra of a box; those with a common face are joined, in the mesh by lines between their centres."""
    folder.mkdir()
    nx, ny, nz = sides
    cells = numpy.stack(numpy.meshgrid(*map(numpy.arange, (nz, ny, nx)), indexing="ij"), -1).reshape(-1, 3)[:, ::-1]
    number = numpy.array([1, nx, nx * ny])
    corner = numpy.array([1, nx + 1, (nx + 1) * (ny + 1)])
    steps = numpy.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])  # parRSB's order
    corners = cells[:, None, :] + steps
    numpy.save(folder / "corners.npy", (corners @ corner).reshape(-1))
    numpy.save(folder / "coordinates.npy", corners.reshape(-1))
    lines = numpy.concatenate([numpy.stack([c @ number, c @ number + number[k]], -1)
                               for k in range(3) for c in [cells[cells[:, k] + 1 < sides[k]]]])
    ends = numpy.concatenate([lines, lines[:, ::-1]])
    ends = ends[numpy.lexsort((ends[:, 1], ends[:, 0]))]
    numpy.save(folder / "offsets.npy", numpy.searchsorted(ends[:, 0], numpy.arange(len(cells) + 1)))
    numpy.save(folder / "neighbours.npy", ends[:, 1])
    meshio.write(folder / "mesh.vtu", meshio.Mesh(cells.astype(float), [("line", lines)]), compression=None)
    return Problem(folder / "mesh.vtu", folder)


def graph_peers(options, problem, ranks, parts):
    ours = {f"meshorder, `{kind}`": lambda kind=kind: by_meshorder(options, problem, ranks, parts, kind)
            for kind in ("ptscotch", "rsb", "hilbert")}
    sphynx = {f"Sphynx, {kind}": lambda kind=kind: by_program(options, "sphynx", problem.folder, problem, ranks, parts, [kind])
              for kind in SPHYNX}
    return ours | {"METIS k-way, one process": lambda: by_metis(problem, parts)} | sphynx


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path, help="build/bin/meshorder, with the peers' programs beside it")
    parser.add_argument("meshes", type=pathlib.Path, nargs="*", help="of tetrahedra, connected")
    parser.add_argument("--hexahedra", type=int, nargs=3, metavar="SIDE", help="partition a box of so many hexahedra on its sides")
    parser.add_argument("--ranks", type=int, nargs="+", default=[4])
    parser.add_argument("--parts", type=int, nargs="+", help="of meshes; as many as ranks if not given")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--mpirun", default="mpirun --oversubscribe", help="what starts ranks")
    options = parser.parse_args()
    options.program = options.program.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for mesh in options.meshes:
            problem = mesh_problem(options, mesh, folder / mesh.stem)
            for ranks in options.ranks:
                for parts in options.parts or [ranks]:
                    title = f"{mesh.stem}: {problem.size:,} vertices in {parts} parts on {ranks} ranks"
                    peers = graph_peers(options, problem, ranks, parts)
                    if parts == ranks:
                        peers["DOLFINx"] = lambda: by_dolfinx(options, problem, ranks)
                    told = measured(options, peers)
                    print_parts(title, told)
                    if "DOLFINx" in told:
                        print_pipelines(f"{title}, from elements to numbers", told)
        if options.hexahedra:
            problem = box_problem(options.hexahedra, folder / "box")
            for ranks in options.ranks:
                peers = graph_peers(options, problem, ranks, ranks)
                peers["parRSB"] = lambda: by_program(options, "parrsb", problem.folder, problem, ranks, ranks)
                print_parts(f"{problem.size:,} hexahedra in {ranks} parts on {ranks} ranks", measured(options, peers))


if __name__ == "__main__":
    main()
