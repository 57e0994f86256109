# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""BiCGSTAB with an incomplete factor in SciPy, both with default options: scipy_ilu.py MATRIX"""
import sys
import time

import numpy
import scipy.io
from scipy.sparse.linalg import LinearOperator, bicgstab, spilu
from solve import report

matrix = scipy.io.mmread(sys.argv[1]).tocsr()
right = numpy.ones(matrix.shape[0])
begin = time.process_time()
factor = spilu(matrix.tocsc(), drop_tol=1e-4)
iterates = []
u, failed = bicgstab(matrix, right, M=LinearOperator(matrix.shape, factor.solve), callback=iterates.append)
assert not failed
report(time.process_time() - begin, right @ u, len(iterates))
