# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Shared by the programs in Python."""
from scipy.sparse import diags
from scipy.sparse.linalg import cg


def conjugate_gradients(matrix, right, preconditioner=None):
    """Returns the solution and the iterations; the diagonal is the default preconditioner."""
    count = [0]

    def step(_):
        count[0] += 1
    if preconditioner is None:
        preconditioner = diags(1 / matrix.diagonal())
    solution, failed = cg(matrix, right, M=preconditioner, callback=step, maxiter=10000)
    assert not failed
    return solution, count[0]


def gradients_of_petsc(matrix, right, preconditioner):
    """Does the same with PETSc, for its own matrix and vector."""
    from petsc4py import PETSc
    solver = PETSc.KSP().create()
    solver.setOperators(matrix)
    solver.setType("cg")
    solver.getPC().setType(preconditioner)
    solver.setTolerances(rtol=1e-8, max_it=10000)
    solution = matrix.createVecRight()
    solver.solve(right, solution)
    return solution, solver.getIterationNumber()


def report(seconds, energy, iterations=None):
    """Prints what `meshorder try` reads."""
    print(f"compute: {seconds:.6f} s")
    print("energy:", energy)
    if iterations is not None:
        print("iterations:", iterations)
