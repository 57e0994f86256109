#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""What orders of cells are worth in OpenFOAM: the time that a step of icoFoam takes in each.

Usage: openfoam.py FOLDER [--edge N | --gmsh SIZE] [--pressure PCG|GAMG] [--rounds N] [--orders NAME…]

A box of fluid whose lid moves, in a mesh of N³ cubes by blockMesh or of tetrahedra of that SIZE by Gmsh (whose Python
package it needs). `scrambled` is a random order, `original` that of the mesh's maker, `default` that of renumberMesh
without a dictionary, and others are methods of `meshorder openfoam --cells`. All but `original` and `scrambled` start
from the scrambled mesh (--gmsh: from the original). Each round runs all orders in a random sequence, five steps each; the
first step is left out. Times are of the processor, as OpenFOAM prints them. MESHORDER names the command, else
build/bin/meshorder is taken.
"""
import argparse
import os
import pathlib
import random
import re
import shutil
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "command"))
import foam_cases  # noqa: E402

MESHORDER = os.environ.get("MESHORDER", str(ROOT / "build" / "bin" / "meshorder"))
STEPS = 5
CONTROL = ("application icoFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {end}; deltaT {step}; "
           "writeControl timeStep; writeInterval 1000; writeFormat binary; timeFormat general;")
SOLUTION = ("solvers {{ p {{ solver {pressure}; tolerance 1e-6; relTol 0.01; }} pFinal {{ $p; relTol 0; }} "
            "U {{ solver smoothSolver; smoother symGaussSeidel; tolerance 1e-5; relTol 0; }} }} "
            "PISO {{ nCorrectors 2; nNonOrthogonalCorrectors {corrections}; pRefPoint (0.01 0.01 0.01); pRefValue 0; }}")
SCHEMES_OF_TETRAHEDRA = ("ddtSchemes { default Euler; } gradSchemes { default Gauss linear; } "
                         "divSchemes { default none; div(phi,U) Gauss upwind; } "
                         "laplacianSchemes { default Gauss linear limited 0.5; } "
                         "interpolationSchemes { default linear; } snGradSchemes { default limited 0.5; }")
PRESSURE = {"PCG": "PCG; preconditioner DIC", "GAMG": "GAMG; smoother GaussSeidel"}


def write_tetrahedra(path, size):
    import gmsh
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for name, value in (("MeshSizeMin", size), ("MeshSizeMax", size), ("MshFileVersion", 2.2)):
        gmsh.option.setNumber(f"Mesh.{name}", value)
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    faces = gmsh.model.getEntities(2)
    lid = [tag for _, tag in faces if abs(gmsh.model.occ.getCenterOfMass(2, tag)[1] - 1) < 1e-9]
    walls = [tag for _, tag in faces if tag not in lid]
    for dimension, tags, group, name in ((2, lid, 1, "lid"), (2, walls, 2, "walls"), (3, [1], 3, "box")):
        gmsh.model.addPhysicalGroup(dimension, tags, group)
        gmsh.model.setPhysicalName(dimension, group, name)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(path))
    gmsh.finalize()


def make_original(folder, arguments):
    case = folder / "original"
    solution = SOLUTION.format(pressure=PRESSURE[arguments.pressure], corrections=1 if arguments.gmsh else 0)
    schemes = {"fvSchemes": SCHEMES_OF_TETRAHEDRA} if arguments.gmsh else {}
    foam_cases.write_settings(case, fvSolution=solution, controlDict=CONTROL.format(end=STEPS * 0.004, step=0.004),
                              **schemes)
    if arguments.gmsh:
        write_tetrahedra(folder / "box.msh", arguments.gmsh)
        foam_cases.openfoam("gmshToFoam", case, str(folder / "box.msh"))
    else:
        foam_cases.block_mesh(case, " ".join([str(arguments.edge)] * 3))
    foam_cases.write_fields(case)
    return case


def order(case, method):
    """Puts the cells in the order of a method; returns what renumberMesh prints."""
    if method == "default":
        return foam_cases.openfoam("renumberMesh", case, "-overwrite")
    subprocess.run([MESHORDER, "openfoam", str(case), "--cells", method, "-q"], check=True)
    log = foam_cases.openfoam("renumberMesh", case, "-overwrite", "-dict", "system/renumberMeshDict")
    (case / "constant" / "cellOrder").unlink()
    (case / "system" / "renumberMeshDict").unlink()
    return log


def make_cases(arguments):
    folder = arguments.folder
    original = make_original(folder, arguments)
    scrambled = shutil.copytree(original, folder / "scrambled")
    figures = {}
    figures["original"], figures["scrambled"] = foam_cases.printed_figures(order(scrambled, "scrambled"))
    for name in arguments.orders:
        if name not in figures:
            case = shutil.copytree(original if arguments.gmsh else scrambled, folder / name)
            figures[name] = foam_cases.printed_figures(order(case, name))[1]
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--edge", type=int, default=60)
    parser.add_argument("--gmsh", type=float)
    parser.add_argument("--pressure", choices=PRESSURE, default="PCG")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--orders", nargs="+", default=["scrambled", "original", "default", "auto", "hilbert"])
    arguments = parser.parse_args()
    figures = make_cases(arguments)
    times = {name: [] for name in arguments.orders}
    iterations = {}
    for turn in range(arguments.rounds):
        for name in random.Random(turn).sample(arguments.orders, len(arguments.orders)):
            log = foam_cases.openfoam("icoFoam", arguments.folder / name)
            clock = [float(t) for t in re.findall(r"ExecutionTime = (\S+) s", log)]
            times[name] += [b - a for a, b in zip(clock, clock[1:])]
            counts = [int(n) for n in re.findall(r"Solving for p,.*No Iterations (\d+)", log)]
            iterations[name] = sum(counts) / len(clock)
    print("| order | band | profile | s/step | lowest | highest | iterations/step |\n| --- |" + " ---: |" * 6)
    for name, steps in times.items():
        band, profile = figures[name]
        print(f"| {name} | {band:,.0f} | {profile:.3g} | {statistics.median(steps):.2f} | {min(steps):.2f} "
              f"| {max(steps):.2f} | {iterations[name]:.0f} |", flush=True)


if __name__ == "__main__":
    main()
