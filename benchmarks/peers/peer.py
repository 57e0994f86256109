#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The Fiedler solvers of Python packages, called as compare.py calls the C++ ones:

    peer.py SOLVER GRAPH TOLERANCE VECTOR

Solves up to three times within a second, prints the fastest one's seconds and writes the vector. Exit status 3 and a
line on stderr say that a package is missing.
"""
import sys
import time
import warnings

import numpy
import scipy.sparse
import scipy.sparse.linalg

SHIFT = 1e-8  # off the singular matrix, and far below λ₂


def laplacian_of(offsets, neighbours):
    size = len(offsets) - 1
    adjacency = scipy.sparse.csr_matrix((numpy.ones(len(neighbours)), neighbours, offsets), shape=(size, size))
    return (scipy.sparse.diags(numpy.diff(offsets).astype(float)) - adjacency).tocsr()


def shifted(laplacian):
    return (laplacian + SHIFT * scipy.sparse.identity(laplacian.shape[0])).tocsc()


def lobpcg(preconditioner):
    """SciPy's LOBPCG for one vector, kept orthogonal to the constants."""
    def solver(laplacian, tolerance):
        size = laplacian.shape[0]
        start = numpy.random.default_rng(0).uniform(-0.5, 0.5, (size, 1))
        _, vectors = scipy.sparse.linalg.lobpcg(laplacian, start, Y=numpy.ones((size, 1)), M=preconditioner(laplacian),
                                                tol=tolerance, maxiter=5000, largest=False)
        return vectors[:, 0]
    return solver


def jacobi(laplacian):
    return scipy.sparse.diags(1 / laplacian.diagonal())


def smoothed_aggregation(laplacian):
    import pyamg
    return pyamg.smoothed_aggregation_solver(laplacian).aspreconditioner()


def eigsh(laplacian, tolerance):
    """ARPACK on the inverse, factored with SciPy's defaults."""
    return scipy.sparse.linalg.eigsh(laplacian, k=2, sigma=-SHIFT, tol=tolerance)[1][:, 1]


def eigenpairs(laplacian, count, tolerance):
    """Returns the lowest eigenvalues, ascending, and their vectors: as eigsh, with SuperLU in its symmetric mode."""
    factors = scipy.sparse.linalg.splu(shifted(laplacian), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0,
                                       options={"SymmetricMode": True})
    inverse = scipy.sparse.linalg.LinearOperator(laplacian.shape, factors.solve, dtype=float)
    return scipy.sparse.linalg.eigsh(laplacian, k=count, sigma=-SHIFT, OPinv=inverse, tol=tolerance)


def eigsh_symmetric(laplacian, tolerance):
    return eigenpairs(laplacian, 2, tolerance)[1][:, 1]


def networkx_solver(method):
    def solver(graph, tolerance):
        import networkx
        return networkx.fiedler_vector(graph, method=method, tol=tolerance, seed=0)
    return solver


SOLVERS = {
    "scipy-lobpcg": lobpcg(lambda _: None),
    "scipy-lobpcg-jacobi": lobpcg(jacobi),
    "scipy-lobpcg-pyamg": lobpcg(smoothed_aggregation),
    "scipy-eigsh": eigsh,
    "scipy-eigsh-symmetric": eigsh_symmetric,
    "networkx-tracemin_lu": networkx_solver("tracemin_lu"),
    "networkx-tracemin_pcg": networkx_solver("tracemin_pcg"),
    "networkx-lobpcg": networkx_solver("lobpcg"),
}


def prepared(name, folder):
    """Returns the solver's input: the Laplacian, or for networkx a graph of its own."""
    laplacian = laplacian_of(numpy.load(folder + "/offsets.npy"), numpy.load(folder + "/neighbours.npy"))
    if not name.startswith("networkx"):
        return laplacian
    import networkx
    graph = networkx.Graph()
    graph.add_nodes_from(range(laplacian.shape[0]))
    upper = scipy.sparse.triu(laplacian, 1)
    graph.add_edges_from(zip(upper.row.tolist(), upper.col.tolist()))
    return graph


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    name, folder, tolerance, target = sys.argv[1], sys.argv[2], float(sys.argv[3]), sys.argv[4]
    warnings.simplefilter("ignore")
    problem = prepared(name, folder)
    times = []
    while len(times) < 3 and sum(times) < 1:
        start = time.perf_counter()
        vector = SOLVERS[name](problem, tolerance)
        times.append(time.perf_counter() - start)
    numpy.asarray(vector, dtype=float).tofile(target)
    print(min(times))


if __name__ == "__main__":
    try:
        main()
    except ModuleNotFoundError as error:
        print(f"needs the Python package {error.name}", file=sys.stderr)
        sys.exit(3)
