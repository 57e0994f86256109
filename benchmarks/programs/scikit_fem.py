# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""−Δu + u = 1 by linear tetrahedra in scikit-fem and SciPy's conjugate gradients: scikit_fem.py MESH"""
import sys
import time

import skfem
from skfem.helpers import dot, grad
from solve import conjugate_gradients, report

mesh = skfem.MeshTet.load(sys.argv[1])
begin = time.process_time()
basis = skfem.Basis(mesh, skfem.ElementTetP1())
matrix = skfem.BilinearForm(lambda u, v, _: dot(grad(u), grad(v)) + u * v).assemble(basis)
right = skfem.LinearForm(lambda v, _: v).assemble(basis)
u, iterations = conjugate_gradients(matrix, right)
report(time.process_time() - begin, right @ u, iterations)
