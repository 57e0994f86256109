# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Conjugate gradients with an incomplete Cholesky factor in PETSc: petsc.py MATRIX"""
import sys
import time

import numpy
import scipy.io
from petsc4py import PETSc
from solve import report

matrix = scipy.io.mmread(sys.argv[1]).tocsr()
a = PETSc.Mat().createAIJ(matrix.shape, csr=(matrix.indptr, matrix.indices, matrix.data))
right, u = a.createVecRight(), a.createVecLeft()
right.set(1)
solver = PETSc.KSP().create()
solver.setOperators(a)
solver.setType("cg")
solver.getPC().setType("icc")
solver.setTolerances(rtol=1e-8, max_it=10000)
begin = time.process_time()
solver.setUp()
solver.solve(right, u)
report(time.process_time() - begin, right.dot(u), solver.getIterationNumber())
