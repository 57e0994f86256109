# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Conjugate gradients preconditioned by the diagonal in SciPy, mostly products with a sparse matrix: scipy_diagonal.py MATRIX"""
import sys
import time

import numpy
import scipy.io
from solve import conjugate_gradients, report

matrix = scipy.io.mmread(sys.argv[1]).tocsr()
right = numpy.ones(matrix.shape[0])
begin = time.process_time()
u, iterations = conjugate_gradients(matrix, right)
report(time.process_time() - begin, right @ u, iterations)
