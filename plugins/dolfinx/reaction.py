# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
# The forms that the test and the measuring program assemble, for ffcx: −Δu + u = 1 + x, natural boundary conditions.
from ufl import (FiniteElement, FunctionSpace, Mesh, SpatialCoordinate, TestFunction, TrialFunction, VectorElement, dx,
                 grad, inner, tetrahedron)

mesh = Mesh(VectorElement("Lagrange", tetrahedron, 1))
space = FunctionSpace(mesh, FiniteElement("Lagrange", tetrahedron, 1))
u, v = TrialFunction(space), TestFunction(space)
a = inner(grad(u), grad(v)) * dx + inner(u, v) * dx
L = (1 + SpatialCoordinate(mesh)[0]) * v * dx
