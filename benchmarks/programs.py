#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Measures the gain of orders in other people's programs, by `meshorder try`.

Usage: programs.py FOLDER [PROGRAM…] [--size SIZE] [--budget SECONDS] [--json FILE]
       programs.py --from FILE

All programs, or those named, compute on a block with a hole, which Gmsh fills with tetrahedra of that SIZE (its Python
package is needed), or on the matrix of −Δu + u on it by linear elements; icoFoam on a box whose lid moves. The meshes are
in the order in which Gmsh leaves them. Programs that are not installed are skipped. On one thread, by processor time.
MESHORDER names the command; by default it is build/bin/meshorder. Prints a table in Markdown; --json adds the results of
`try --json` to the file, and --from prints the table from this file again.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[1]
HERE = pathlib.Path(__file__).resolve().parent / "programs"
MESHORDER = os.environ.get("MESHORDER", str(ROOT / "build" / "bin" / "meshorder"))
ONE_THREAD = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
COMPUTE = ("--time", r"compute: (\S+)", "--same", r"energy: (\S+)", "--tolerance", "1e-4")
ITERATIONS = ("--count", r"iterations: (\d+)")


# ---- meshes

class Block:
    """A block with a hole: its nodes, its tetrahedra, and the nodes of two ends."""

    def __init__(self, folder, size):
        import gmsh
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        for name, value in (("MeshSizeMin", size), ("MeshSizeMax", size), ("MshFileVersion", 2.2),
                            ("SaveElementTagType", 2)):
            gmsh.option.setNumber(f"Mesh.{name}", value)
        occ = gmsh.model.occ
        occ.cut([(3, occ.addBox(0, 0, 0, 2, 1, 1))], [(3, occ.addCylinder(1, 0.5, -1, 0, 0, 3, 0.25))])
        occ.synchronize()
        for dimension, name in ((2, "skin"), (3, "body")):
            tags = [tag for _, tag in gmsh.model.getEntities(dimension)]
            gmsh.model.addPhysicalGroup(dimension, tags, dimension, name)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(folder / "block.msh"))
        gmsh.write(str(folder / "block.mesh"))
        tags, points, _ = gmsh.model.mesh.getNodes()
        _, elements = gmsh.model.mesh.getElementsByType(4)
        gmsh.finalize()
        # the order in Gmsh's file: nodes by tag
        order = numpy.argsort(tags)
        self.points = points.reshape(-1, 3)[order]
        self.tetrahedra = numpy.searchsorted(tags[order], elements.reshape(-1, 4))

    def write_deck(self, path, solver):
        with path.open("w") as deck:
            deck.write("*NODE\n" + "".join(f"{n}, {x!r}, {y!r}, {z!r}\n"
                                           for n, (x, y, z) in enumerate(self.points.tolist(), 1)))
            deck.write("*ELEMENT, TYPE=C3D4, ELSET=BODY\n" + "".join(
                f"{e}, " + ", ".join(str(v + 1) for v in corners) + "\n"
                for e, corners in enumerate(self.tetrahedra.tolist(), 1)))
            for name, place in (("HELD", 0), ("PULLED", 2)):
                nodes = numpy.flatnonzero(abs(self.points[:, 0] - place) < 1e-9) + 1
                deck.write(f"*NSET, NSET={name}\n" + "".join(f"{n},\n" for n in nodes))
            deck.write("*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n"
                       f"*BOUNDARY\nHELD, 1, 3\n*STEP\n*STATIC, SOLVER={solver}\n*CLOAD\n"
                       "PULLED, 1, 1.0\nPULLED, 2, 1.0\nPULLED, 3, 1.0\n"
                       "*NODE PRINT, NSET=HELD, TOTALS=ONLY\nRF\n*END STEP\n")

    def write_matrix(self, path):
        import scipy.io
        import scipy.sparse
        corners = self.points[self.tetrahedra]
        edges = corners[:, 1:] - corners[:, :1]
        volumes = abs(numpy.linalg.det(edges)) / 6
        of_three = numpy.linalg.inv(edges).transpose(0, 2, 1)
        gradients = numpy.concatenate([-of_three.sum(axis=1, keepdims=True), of_three], axis=1)
        masses = (numpy.ones((4, 4)) + numpy.eye(4)) / 20
        values = volumes[:, None, None] * (gradients @ gradients.transpose(0, 2, 1) + masses)
        rows = numpy.repeat(self.tetrahedra, 4, axis=1).ravel()
        columns = numpy.tile(self.tetrahedra, (1, 4)).ravel()
        matrix = scipy.sparse.coo_matrix((values.ravel(), (rows, columns)), shape=(len(self.points),) * 2).tocsr()
        scipy.io.mmwrite(str(path), matrix, symmetry="symmetric")

    def write_body(self, path):
        """The tetrahedra alone."""
        import meshio
        meshio.write(str(path), meshio.Mesh(self.points, [("tetra", self.tetrahedra)]))


# ---- programs: title, file, what is tried, how it is judged

def python(script):
    return [sys.executable, str(HERE / script), "{}"]


def ccx(title, stem):
    return title, f"{stem}.inp", ["ccx", "{stem}"], ("--same-file", f"{stem}.dat", "--tolerance", "1e-2")


def ico_foam(case):
    *shape, pressure = case.split("-")
    title = f"icoFoam, {pressure.upper()}, " + ("cubes by blockMesh" if shape else "tetrahedra")
    return title, case, ["icoFoam"], ("--count", r"Solving for p,.*No Iterations (\d+)")


PROGRAMS = {
    "ccx-spooles": ccx("CalculiX, SPOOLES", "spooles"),
    "ccx-scaling": ccx("CalculiX, iterative scaling", "scaling"),
    "ccx-cholesky": ccx("CalculiX, iterative Cholesky", "cholesky"),
    **{f"icofoam-{case}": ico_foam(case) for case in ("pcg", "gamg", "cubes-pcg", "cubes-gamg")},
    "freefem": ("FreeFEM, assembly and CG", "block.mesh",
                ["FreeFem++", "-nw", "-ne", str(HERE / "freefem.edp"), "{}"], COMPUTE),
    "scikit-fem": ("scikit-fem, assembly and SciPy's CG", "block.msh", python("scikit_fem.py"), COMPUTE + ITERATIONS),
    "sfepy": ("SfePy, assembly and SciPy's CG", "body.mesh", python("sfepy_poisson.py"), COMPUTE + ITERATIONS),
    "ngsolve": ("NGSolve, assembly and CG", "block.msh", python("ngsolve_poisson.py"), COMPUTE),
    "dolfinx": ("DOLFINx, assembly and PETSc's CG", "body.xdmf", python("dolfinx_poisson.py"), COMPUTE + ITERATIONS),
    "scipy-products": ("SciPy, CG with the diagonal", "block.mtx", python("scipy_diagonal.py"), COMPUTE + ITERATIONS),
    "scipy-ilu": ("SciPy, ILU and BiCGSTAB", "block.mtx", python("scipy_ilu.py"), COMPUTE + ITERATIONS),
    "petsc": ("PETSc, CG with ICC(0)", "block.mtx", python("petsc.py"), COMPUTE + ITERATIONS),
    "mesh-graph-net": ("a MeshGraphNet in PyTorch", "block.msh", python("mesh_graph_net.py"), COMPUTE),
}
SOLVERS = {"spooles": "SPOOLES", "scaling": "ITERATIVE SCALING", "cholesky": "ITERATIVE CHOLESKY"}


def make(folder, file, arguments):
    """Makes the file that a program reads, in a folder of its own; returns its path."""
    path = folder / file.replace(".", "-") / file
    if path.exists():
        return path
    path.parent.mkdir(parents=True, exist_ok=True)
    stem, suffix = path.stem, path.suffix
    if not suffix:
        sys.path.insert(0, str(HERE))
        import openfoam_case
        *shape, pressure = stem.split("-")
        openfoam_case.write(path, arguments.size, pressure.upper(), bool(shape))
        return path
    block = Block(path.parent, arguments.size * (2 if stem in ("spooles", "cholesky") else 1))
    if suffix == ".inp":
        block.write_deck(path, SOLVERS[stem])
    elif suffix == ".mtx":
        block.write_matrix(path)
    elif stem == "body":
        block.write_body(path)
    for other in (path.parent / "block.msh", path.parent / "block.mesh"):
        if other != path:
            other.unlink()
    return path


def attempt(path, program, judged, budget):
    """Returns what `try` finds, or None, and its error message."""
    environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", "FF_LOADPATH": "/usr/lib/freefem++",
                   **os.environ, **ONE_THREAD, "PYTHONPATH": str(HERE)}
    done = subprocess.run([MESHORDER, "try", str(path), "--budget", str(budget), "--json", "--quiet", *judged,
                           "--", *program], capture_output=True, text=True, check=False, env=environment)
    if done.returncode != 0:
        return None, done.stderr.strip()
    return json.loads(done.stdout), ""


def number(value, digits=3):
    return "" if value is None else f"{value:.{digits}g}"


def gain(order):
    if order is None or order["ratio"] is None:
        return ""
    interval = order["interval"]
    return f"{order['ratio']:.2f}" + (f" ({interval[0]:.2f}–{interval[1]:.2f})" if interval else "")


HEAD = ("| program | as it is | best order | times as fast | `auto` | iterations |\n"
        "| --- | ---: | --- | ---: | ---: | ---: |")


def row(found):
    orders = found["orders"]
    own = orders[0]
    auto = next((order for order in orders if order["by_auto"]), None)
    best = next(order for order in orders if order["name"] == found["best"])
    iterations = "" if own["count"] is None else f"{own['count']:.0f} → {best['count']:.0f}"
    decided = found["verdict"] in ("faster", "slower", "tie")
    gain_of_best = gain(best) if decided else "not told apart"
    gain_of_auto = "stays" if auto is None else gain(auto) if decided else "not told apart"
    return (f"| {found['title']} | {number(own['time'])} s | {found['best']} | {gain_of_best} | "
            f"{gain_of_auto} | {iterations} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, nargs="?")
    parser.add_argument("programs", nargs="*", metavar="PROGRAM", default=list(PROGRAMS))
    parser.add_argument("--size", type=float, default=0.028)
    parser.add_argument("--budget", type=float, default=120)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--from", type=pathlib.Path, dest="kept")
    arguments = parser.parse_args()
    if arguments.kept:
        print(HEAD, *map(row, json.loads(arguments.kept.read_text()).values()), sep="\n")
        return
    if not arguments.folder:
        parser.error("give a folder for the meshes")
    for name in arguments.programs:
        if name not in PROGRAMS:
            parser.error(f"{name}: unknown; known: {' '.join(PROGRAMS)}")
    arguments.folder.mkdir(parents=True, exist_ok=True)
    everything = json.loads(arguments.json.read_text()) if arguments.json and arguments.json.exists() else {}
    print(HEAD, flush=True)
    for name in arguments.programs:
        title, file, program, judged = PROGRAMS[name]
        if not shutil.which(program[0]):
            print(f"{name}: skipped, {program[0]} is not installed", file=sys.stderr)
            continue
        found, fault = attempt(make(arguments.folder, file, arguments), program, judged, arguments.budget)
        if found is None:
            print(f"{name}: {fault}", file=sys.stderr)
            continue
        everything[name] = {"title": title, "size": arguments.size, **found}
        print(row(everything[name]), flush=True)
        if arguments.json:
            arguments.json.write_text(json.dumps(everything, indent=1) + "\n")


if __name__ == "__main__":
    main()
