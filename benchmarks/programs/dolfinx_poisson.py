# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""−Δu + u = 1 by linear tetrahedra in DOLFINx: dolfinx_poisson.py MESH"""
import sys
import time

import dolfinx
import ufl
from dolfinx.fem.petsc import assemble_matrix, assemble_vector
from mpi4py import MPI
from petsc4py import PETSc
from solve import gradients_of_petsc, report

with dolfinx.io.XDMFFile(MPI.COMM_WORLD, sys.argv[1], "r") as file:
    mesh = file.read_mesh(name="Grid")
space = dolfinx.fem.FunctionSpace(mesh, ("Lagrange", 1))
u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
form = dolfinx.fem.form((ufl.dot(ufl.grad(u), ufl.grad(v)) + u * v) * ufl.dx)
load = dolfinx.fem.form(dolfinx.fem.Constant(mesh, PETSc.ScalarType(1)) * v * ufl.dx)
begin = time.process_time()
matrix = assemble_matrix(form)
matrix.assemble()
right = assemble_vector(load)
x, iterations = gradients_of_petsc(matrix, right, "jacobi")
report(time.process_time() - begin, right.dot(x), iterations)
