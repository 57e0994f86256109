# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The first mistakes of users: each message names the fault and the remedy."""

import re

import meshio
import meshorder
import networkx
import numpy as np
import pytest
import scipy.sparse

POINTS = np.random.default_rng(1).random((60, 3))
TETRAHEDRA = np.random.default_rng(2).permuted(np.tile(np.arange(60), (50, 1)), axis=1)[:, :4].astype(np.int32)
MATRIX = scipy.sparse.csr_array(scipy.sparse.random(60, 60, 0.1, random_state=3) + scipy.sparse.eye(60))
EDGES = np.stack(MATRIX.nonzero())


def with_data(**data):
    mesh = meshio.Mesh(POINTS, [("tetra", TETRAHEDRA)])
    for name, values in data.items():
        getattr(mesh, name).update(values)
    return mesh


MISTAKES = {
    "transposed cells with a name": (
        lambda: meshorder.order_mesh(POINTS, {"tetra": TETRAHEDRA.T}),
        "cells of type tetra: each row has 50 vertices, expected 4; cells of another kind need its name, as in 'triangle6', "
        "or the array is transposed",
    ),
    "cells of another width": (
        lambda: meshorder.order_mesh(POINTS, {"triangle": TETRAHEDRA}),
        "cells of type triangle: each row has 4 vertices, expected 3; cells of another kind need its name, as in 'triangle6'",
    ),
    "cells with a wrong number of vertices": (
        lambda: meshorder.order_mesh(POINTS, {"tetra10": TETRAHEDRA}),
        "cells of type tetra10: each row has 4 vertices, expected 10; cells of another kind need its name, as in 'triangle6'",
    ),
    "transposed cells without a name": (
        lambda: meshorder.order_mesh(POINTS, TETRAHEDRA.T),
        "cells: 50 vertices each: is the array transposed? A row for each cell is expected",
    ),
    "cells of an unknown width": (
        lambda: meshorder.order_mesh(POINTS, np.zeros((60, 5), int)),
        "cells: 5 vertices each: this does not say the type; name it, as in {'triangle6': cells}",
    ),
    "transposed points": (
        lambda: meshorder.order_mesh(POINTS.T, TETRAHEDRA),
        "points: expected rows of 1 to 3 coordinates, not the shape (3, 60); pass the transpose, .T",
    ),
    "data of another size": (
        lambda: meshorder.reorder(with_data(point_data={"u": np.zeros(59)})),
        "data 'u': expected 60 rows, not the shape (59,)",
    ),
    "cell data of another size": (
        lambda: meshorder.reorder(with_data(cell_data={"q": [np.zeros(49)]})),
        "data 'q': expected 50 rows, not the shape (49,)",
    ),
    "a mask for a set": (
        lambda: meshorder.reorder(with_data(point_sets={"s": POINTS[:, 0] > 0.5})),
        "set 's': expected integers, not bool; np.flatnonzero makes indices of a mask",
    ),
    "the path of a matrix": (
        lambda: meshorder.order("a.mtx"),
        "graph: expected a SciPy matrix, (indptr, indices), a networkx graph, an edge_index of shape (2, E), or a sparse matrix "
        "or Data of PyTorch, not str; scipy.io.mmread(path).tocsr() reads a matrix",
    ),
    "a dense matrix": (
        lambda: meshorder.order(MATRIX.toarray()),
        "graph: expected a SciPy matrix, (indptr, indices), a networkx graph, an edge_index of shape (2, E), or a sparse matrix "
        "or Data of PyTorch, not ndarray of shape (60, 60); scipy.sparse.csr_array makes a sparse matrix of a dense one",
    ),
    "a list of edges": (
        lambda: meshorder.order(EDGES.T),
        "graph: expected a SciPy matrix, (indptr, indices), a networkx graph, an edge_index of shape (2, E), or a sparse matrix "
        f"or Data of PyTorch, not ndarray of shape {EDGES.T.shape}; pass the transpose of an array of edges, .T",
    ),
    "edges that name no node": (lambda: meshorder.order(EDGES - 1), "edge_index: there is no node -1"),
    "a list of methods": (
        lambda: meshorder.order(MATRIX, ["rcm"]),  # type: ignore[arg-type]
        "method: expected the name of one of meshorder.methods(), not ['rcm']",
    ),
    "no coordinates": (
        lambda: meshorder.order(MATRIX, "hilbert"),
        "order 'hilbert' needs the coordinates of all 60 vertices (points), got none",
    ),
    "a matrix for weights": (
        lambda: meshorder.order(MATRIX, weights=MATRIX),
        "weights: expected a number for each entry, not a matrix; pass its .data",
    ),
    "an array for an order": (
        lambda: meshorder.quality(MATRIX, np.arange(60)),  # type: ignore[arg-type]
        "order: expected an Order or Permutation, not ndarray; Permutation(new_to_old=array) makes one",
    ),
    "a permutation without a direction": (
        lambda: meshorder.Permutation(np.arange(60)),
        "Permutation: which direction? Pass new_to_old=p if a[p] has the new order, else old_to_new=p",
    ),
    "another axis": (
        lambda: meshorder.Permutation.identity(60).move(np.zeros((1, 60))),
        "move: expected 60 entries along axis 0, not the shape (1, 60); axis=1 has as many",
    ),
    "a number to move": (
        lambda: meshorder.Permutation.identity(60).move(3),
        "move: expected 60 entries along axis 0, not the shape ()",
    ),
    "a networkx graph to move": (
        lambda: meshorder.Permutation.identity(6).move(networkx.path_graph(6)),
        "move: a networkx graph has no rows; [list(graph)[k] for k in new_to_old] orders its nodes",
    ),
    "a matrix to write": (
        lambda: meshorder.write(MATRIX, "w.mtx"),
        "mesh: expected (points, cells), a mesh of meshorder, meshio, PyVista, VTK, scikit-fem, trimesh or Gmsh, or a graph of "
        "PyTorch, not csr_array; meshorder.order(matrix).permutation.move(matrix) orders a matrix",
    ),
    "arguments of write in another order": (
        lambda: meshorder.write("a.vtu", with_data()),
        "mesh: expected (points, cells), a mesh of meshorder, meshio, PyVista, VTK, scikit-fem, trimesh or Gmsh, or a graph of "
        "PyTorch, not str; meshorder.read makes a mesh of a file, meshorder.write(mesh, path) writes one",
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes_get_a_remedy(mistake):
    call, message = MISTAKES[mistake]
    with pytest.raises(meshorder.InvalidArgument) as error:
        call()
    assert str(error.value) == message


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: meshorder.order(MATRIX, thread=2), "unexpected keyword argument 'thread'; did you mean 'threads'?"),
        (lambda: meshorder.order(MATRIX, zzz=2), "unexpected keyword argument 'zzz'"),
    ],
)
def test_misspelt_options_get_a_suggestion(call, message):
    with pytest.raises(TypeError, match=re.escape(message) + "$"):
        call()


def test_results_name_what_their_permutations_have():
    order = meshorder.order(MATRIX)
    with pytest.raises(AttributeError, match=r"an Order has no 'move'; use \.permutation\.move"):
        order.move(np.zeros(60))
    with pytest.raises(TypeError, match="which direction"):
        np.zeros(60)[order]
    of_mesh = meshorder.order_mesh(POINTS, TETRAHEDRA)
    for name in ("permutation", "old_to_new", "move"):
        with pytest.raises(AttributeError, match=f"a MeshOrder has no '{name}': use that of its .vertices or .cells"):
            getattr(of_mesh, name)
    for result in (order, of_mesh):
        assert not hasattr(result, "anything_else")


@pytest.mark.parametrize("name, width", [("tetrahedron", 10), ("tetra", 4), ("hexahedron", 27), ("wedge", 15), ("polygon", 7)])
def test_cells_have_the_numbers_of_vertices_that_their_type_can_have(name, width):
    cells = np.arange(2 * width).reshape(2, width)
    assert len(meshorder.order_mesh(POINTS, {name: cells}).cells.permutation) == 2


def test_an_asymmetric_matrix_is_judged_as_it_is_ordered():
    order = meshorder.order(MATRIX)
    both = abs(MATRIX) + abs(MATRIX.T)
    assert meshorder.quality(MATRIX, order) == meshorder.quality(both, order)
    assert meshorder.quality(MATRIX) == meshorder.quality(both)


def test_an_edge_index_of_numpy_is_a_graph():
    order = meshorder.order(EDGES, "rcm")
    assert order.old_to_new.tolist() == meshorder.order(MATRIX, "rcm").old_to_new.tolist()
    assert meshorder.quality(EDGES, order) == meshorder.quality(MATRIX, order)
    assert meshorder.fiedler(EDGES).lambda2 == pytest.approx(meshorder.fiedler(MATRIX).lambda2)
