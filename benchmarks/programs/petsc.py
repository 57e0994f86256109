# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Conjugate gradients with an incomplete Cholesky factor in PETSc: petsc.py MATRIX"""
import sys
import time

import scipy.io
from petsc4py import PETSc
from solve import gradients_of_petsc, report

matrix = scipy.io.mmread(sys.argv[1]).tocsr()
a = PETSc.Mat().createAIJ(matrix.shape, csr=(matrix.indptr, matrix.indices, matrix.data))
right = a.createVecRight()
right.set(1)
begin = time.process_time()
u, iterations = gradients_of_petsc(a, right, "icc")
report(time.process_time() - begin, right.dot(u), iterations)
