#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Makes the meshes of this folder by Gmsh's Python module and the program tetgen; tests read what is committed.

Usage: python3 make.py FOLDER
"""
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import gmsh


def options(**values):
    for name, value in values.items():
        gmsh.option.setNumber(f"Mesh.{name}", value)


def blocks(folder):
    """Three blocks of different materials, in Gmsh's older format."""
    for k in range(3):
        gmsh.model.occ.addBox(k, 0, 0, 1, 1, 1 + 0.5 * (k % 2))
    gmsh.model.occ.fragment([(3, 1)], [(3, 2), (3, 3)])
    gmsh.model.occ.synchronize()
    for tag in (1, 2, 3):
        gmsh.model.addPhysicalGroup(3, [tag], tag)
    options(MshFileVersion=2.2, MeshSizeMax=0.4)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(folder / "blocks.msh"))


def ball(folder):
    """A ball of curved tetrahedra of order 4, whose nodes are in VTK's order nowhere."""
    gmsh.model.occ.addSphere(0, 0, 0, 1)
    gmsh.model.occ.synchronize()
    options(MshFileVersion=4.1, MeshSizeMin=1.2, MeshSizeMax=1.2, ElementOrder=4)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(folder / "ball.msh"))


def arch(folder):
    """Half a ring of hexahedra."""
    face = gmsh.model.occ.addRectangle(1, 0, 0, 0.5, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setTransfiniteSurface(face)
    gmsh.model.mesh.setRecombine(2, face)
    gmsh.model.occ.revolve([(2, face)], 0, 0, 0, 0, 1, 0, math.pi, [12], recombine=True)
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [1], 5)
    options(MshFileVersion=4.1, MeshSizeMin=0.3, MeshSizeMax=0.3)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(folder / "arch.msh"))


def ring(folder):
    """A torus of tetrahedra by TetGen, with its boundary faces and a number for the region."""
    around, across = 16, 8
    points, faces = [], []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            radius = 1 + 0.35 * math.cos(b)
            points.append((radius * math.cos(a), radius * math.sin(a), 0.35 * math.sin(b)))
            faces.append([((i + p) % around) * across + (j + q) % across for p, q in ((0, 0), (1, 0), (1, 1), (0, 1))])
    lines = [f"{len(points)} 3 0 0", *(f"{k} {x:.6f} {y:.6f} {z:.6f}" for k, (x, y, z) in enumerate(points)),
             f"{len(faces)} 0", *("1\n4 " + " ".join(map(str, face)) for face in faces), "0", "1", "0 1 0 0 7"]
    with tempfile.TemporaryDirectory() as made:
        (pathlib.Path(made) / "ring.poly").write_text("\n".join(lines) + "\n")
        subprocess.run(["tetgen", "-pqAQ", "ring.poly"], cwd=made, check=True)
        for extension in ("node", "ele", "face"):
            os.replace(pathlib.Path(made) / f"ring.1.{extension}", folder / f"ring.{extension}")


def main():
    folder = pathlib.Path(sys.argv[1])
    for make in (blocks, ball, arch, ring):
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        make(folder)
        gmsh.finalize()


if __name__ == "__main__":
    main()
