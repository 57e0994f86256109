# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The plugin in petsc4py, which loads it by its path: petsc4py_test.py libmeshorder_petsc.so."""
import sys

import petsc4py

petsc4py.init(["petsc4py_test.py", "-dll_append", sys.argv[1]])
from petsc4py import PETSc  # noqa: E402

N = 101
scattered = [(37 * i + 11) % N for i in range(N)]
matrix = PETSc.Mat().createAIJ([N, N], nnz=3)
for i in range(N):
    for j in range(max(i - 1, 0), min(i + 2, N)):
        matrix[scattered[i], scattered[j]] = 2.5 if i == j else -1
matrix.assemble()
rows, columns = matrix.getOrdering("meshorder_rcm")
offsets, entries = matrix.permute(rows, columns).getRowIJ()
assert max(abs(row - column) for row in range(N) for column in entries[offsets[row]:offsets[row + 1]]) == 1

solver = PETSc.KSP().create()
solver.setOperators(matrix)
solver.setType("preonly")
solver.getPC().setType("lu")
solver.getPC().setFactorOrdering("meshorder_rcm")
expected = matrix.createVecRight()
expected.setRandom()
right = matrix * expected
solution = right.duplicate()
solver.solve(right, solution)
assert (solution - expected).norm() < 1e-10
