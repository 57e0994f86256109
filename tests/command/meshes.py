# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Small meshes as text, and computations of the tests without meshorder's code."""
import numpy
import scipy.sparse
import scipy.sparse.linalg

TETGEN_NODE = """5 3 1 1
1 0 0 0 0.5 7
2 1 0 0 1.5 8
3 0 1 0 2.5 7
4 0 0 1 3.5 8
5 1 1 1 4.5 9
"""
TETGEN_ELE = """2 4 1
1 1 2 3 4 10
2 2 3 4 5 20
"""


def write_tetgen(folder, name="mesh"):
    (folder / f"{name}.node").write_text(TETGEN_NODE)
    (folder / f"{name}.ele").write_text(TETGEN_ELE)
    return folder / f"{name}.node"


def read_tetgen(path):
    """Points and cells (0-based) of a .node/.ele pair."""
    def rows(file):
        lines = (line.split("#")[0].split() for line in open(file))
        return [line for line in lines if line]

    nodes = rows(path)
    points = numpy.array([[float(x) for x in row[1:4]] for row in nodes[1:]])
    first = int(nodes[1][0])
    elements = rows(str(path).replace(".node", ".ele"))
    corners = int(elements[0][1])
    cells = numpy.array([[int(v) for v in row[1:1 + corners]] for row in elements[1:]]) - first
    return points, cells


def adjacency(vertices, cells):
    """The vertex graph of cells of one type, as a SciPy matrix of zeros and ones."""
    pairs = [(cells[:, i], cells[:, j]) for i in range(cells.shape[1]) for j in range(cells.shape[1]) if i != j]
    rows = numpy.concatenate([p[0] for p in pairs])
    columns = numpy.concatenate([p[1] for p in pairs])
    matrix = scipy.sparse.csr_matrix((numpy.ones(len(rows)), (rows, columns)), shape=(vertices, vertices))
    matrix.data[:] = 1
    return matrix


def mean_span(matrix, rank):
    upper = scipy.sparse.triu(matrix, k=1).tocoo()
    return numpy.abs(rank[upper.row].astype(float) - rank[upper.col]).mean()


def exact_fiedler(matrix):
    """λ₂ and its vector by SciPy's shift-invert Lanczos with a sparse LU factorisation."""
    laplacian = scipy.sparse.diags(numpy.asarray(matrix.sum(axis=1)).ravel()) - matrix
    values, vectors = scipy.sparse.linalg.eigsh(laplacian.tocsc(), k=3, sigma=-1e-5, which="LM", tol=1e-10)
    order = numpy.argsort(values)
    return values[order[1]], vectors[:, order[1]]
