# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Conjugate gradients with an incomplete factor in SciPy: scipy_ilu.py MATRIX"""
import sys
import time

import numpy
import scipy.io
from scipy.sparse.linalg import LinearOperator, spilu
from solve import conjugate_gradients, report

matrix = scipy.io.mmread(sys.argv[1]).tocsr()
right = numpy.ones(matrix.shape[0])
begin = time.process_time()
factor = spilu(matrix.tocsc(), drop_tol=1e-3, fill_factor=4, permc_spec="NATURAL", diag_pivot_thresh=0,
               options={"SymmetricMode": True})
u, iterations = conjugate_gradients(matrix, right, LinearOperator(matrix.shape, factor.solve))
report(time.process_time() - begin, iterations, right @ u)
