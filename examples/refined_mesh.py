# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Solves Poisson's equation on a mesh that is refined where the solution is steep, and keeps its order fresh.

    python refined_mesh.py [LEVELS]

Prints the time of the matrix-vector product in conjugate gradients, with a Reorderer and without.
"""

import sys
import timeit

import meshorder
import numpy
import scipy.sparse.linalg
import skfem
from skfem.models.poisson import laplace


@skfem.LinearForm
def load(w, at):
    return numpy.exp(-500 * ((at.x[0] - 0.3) ** 2 + (at.x[1] - 0.7) ** 2)) * w


def in_fresh_order(mesh, before, reorderer):
    """Returns `mesh` in a fresh order. Its first `before` vertices are those of the last call."""
    previous = numpy.arange(mesh.p.shape[1])
    previous[before:] = -1  # new vertices
    update = reorderer.update({"triangle": mesh.t.T}, points=mesh.p.T, previous=previous)
    if update.repair == "none":
        return mesh
    points = update.permutation.move(mesh.p.T)
    triangles = update.permutation.renumber(mesh.t.T)
    triangles = triangles[numpy.argsort(triangles.max(axis=1), kind="stable")]
    return skfem.MeshTri(points.T.copy(), triangles.T.copy())


def refine(levels, reorderer):
    """Returns the vertices after `levels` refinements, the seconds that a product takes, and the energy."""
    mesh, before = skfem.MeshTri.init_sqsymmetric().refined(5), 0
    for _ in range(levels):
        if reorderer:
            mesh = in_fresh_order(mesh, before, reorderer)
        basis = skfem.Basis(mesh, skfem.ElementTriP1())
        A, b, u, inside = skfem.condense(laplace.assemble(basis), load.assemble(basis), D=mesh.boundary_nodes())
        u[inside], _ = scipy.sparse.linalg.cg(A, b, rtol=1e-4)
        slope = numpy.sqrt((numpy.linalg.norm(basis.interpolate(u).grad, axis=0) ** 2 * basis.dx).sum(axis=1))
        before = mesh.p.shape[1]
        mesh = mesh.refined(numpy.argsort(-slope)[: slope.size // 4])
    return before, min(timeit.repeat(lambda: A @ b, number=1, repeat=50)), b @ u[inside]


if __name__ == "__main__":
    levels = int(sys.argv[1]) if len(sys.argv) > 1 else 8
    for name, reorderer in (("as refined", None), ("kept fresh", meshorder.Reorderer("rcm"))):
        vertices, seconds, energy = refine(levels, reorderer)
        print(f"{name}: {vertices} vertices, {1e3 * seconds:.2f} ms for a product, energy {energy:.6g}")
