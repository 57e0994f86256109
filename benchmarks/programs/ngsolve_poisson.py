# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""−Δu + u = 1 by linear tetrahedra in NGSolve: ngsolve_poisson.py MESH"""
import sys
import time

import ngsolve
from netgen.read_gmsh import ReadGmsh
from ngsolve import dx, grad
from solve import report

ngsolve.SetNumThreads(1)
mesh = ngsolve.Mesh(ReadGmsh(sys.argv[1]))
space = ngsolve.H1(mesh, order=1)
u, v = space.TnT()
begin = time.process_time()
form = ngsolve.BilinearForm(grad(u) * grad(v) * dx + u * v * dx)
preconditioner = ngsolve.Preconditioner(form, "local")
load = ngsolve.LinearForm(v * dx).Assemble()
form.Assemble()
solver = ngsolve.CGSolver(form.mat, preconditioner.mat, tol=1e-8, maxiter=10000)
x = solver * load.vec
report(time.process_time() - begin, ngsolve.InnerProduct(x, load.vec))
