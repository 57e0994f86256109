# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders of graphs, matrices and meshes, including other libraries' objects."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _arrays
from ._errors import InvalidArgument
from ._graphs import Order, order_graph
from ._meshes import MeshOrder, order_arrays
from ._permutation import Permutation
from .hosts import find_host, host_of
from .hosts.host import Request


def order(
    graph: Any, method: str = "auto", *, points: Any = None, weights: Any = None, **options: Any
) -> Order:
    """Finds new places for the vertices of a graph, or the rows and columns of a matrix. Nothing is moved.

    Args:
        graph: a square SciPy matrix (CSR is read in place, others are converted), ``(indptr, indices)``, a networkx
            graph (vertices in the order of its nodes), a square sparse tensor of PyTorch in COO or CSR form or an
            edge_index, whose vertices are 0 … its largest number; or a mesh or graph that `reorder` takes, whose
            vertices are ordered. A matrix gives its pattern only: its values and diagonal are ignored, as are the
            weights of a networkx graph.
        method: "auto", which chooses by the size and the ``workload``, or the name of one of `methods`.
        points: one row of one to three coordinates for each vertex, or None. Orders along curves ("hilbert", "morton") need
            them, and "auto" uses them.
        weights: one for each entry of the graph, in the order of its arrays, > 0, finite and equal on both sides of the
            diagonal; None: all are 1.
        **options: see `Options`.

    Returns:
        The order; its ``permutation`` moves arrays and matrices.

    Raises:
        InvalidArgument: a faulty graph, an unknown method, missing coordinates, sizes that do not match.
        TooLarge: 2³¹ or more vertices.
        Unavailable: this build lacks the method.
        Stopped: ``progress`` returned False.

    Example:
        >>> import scipy.sparse
        >>> matrix = scipy.sparse.csr_array([[2, 0, 1], [0, 2, 1], [1, 1, 2]])
        >>> order = meshorder.order(matrix, "rcm")
        >>> order.permutation.move(matrix).toarray().tolist()
        [[2, 1, 0], [1, 2, 1], [0, 1, 2]]
    """
    host = find_host(graph)
    if host is None or host.takes_weights:
        return order_graph(graph, method, points, weights, options)
    if points is not None or weights is not None:
        raise InvalidArgument("order: points and weights are for graphs; a mesh has its own points, and no weights")
    return host.order(method, "original", options).vertices


def order_edges(edges: Any, vertices: Permutation) -> Permutation:
    """Orders edges by the larger of the new places of their ends, then by the smaller one.

    A loop over them then touches new vertices nearly in their order, whatever method ordered the vertices.

    Args:
        edges: one row of two old vertex numbers for each edge. If ``renumber`` has changed them already, pass the
            permutation that moves nothing as ``vertices``.
        vertices: the order of the vertices.

    Returns:
        The order of the edges: ``vertices.renumber(order.move(edges))`` is the new list.

    Raises:
        InvalidArgument: ``edges`` have another shape, or name a vertex that does not exist.

    Example::

        order = meshorder.order(matrix).permutation
        edges = order.renumber(meshorder.order_edges(edges, order).move(edges))
    """
    pairs = _arrays.integers(edges, "edges", rank=2)
    if pairs.shape[1] != 2:
        raise InvalidArgument(f"edges: expected two vertices for each, not the shape {pairs.shape}")
    places = np.sort(vertices.renumber(pairs), axis=1)
    return Permutation(new_to_old=np.lexsort((places[:, 0], places[:, 1])))


def order_mesh(
    points: Any, cells: Any = None, *, vertices: str = "auto", elements: str = "auto", vertex_count: int | None = None,
    **options: Any,
) -> MeshOrder:  # fmt: skip
    """Finds new places for the vertices of a mesh and for its cells. Nothing is moved.

    Args:
        points: one row of one to three coordinates for each vertex; or None, together with ``vertex_count``; or, if no
            cells are given, a mesh that `reorder` takes.
        cells: vertex numbers from 0 on, in one of these forms; cells are numbered in the order given:

            - an array with one row for each cell, of 2 vertices (lines), 3 (triangles), 4 (quads if points have one
              or two coordinates, else tetrahedra), and in space only 6 (wedges), 8 (hexahedra) or 10 (second-order
              tetrahedra);
            - ``{type: array}`` or ``[(type, array), …]``, with meshio's names of types: "tetra", "triangle6";
            - ``(offsets, connectivity, types)``, with VTK's type numbers: cell c has the vertices
              ``connectivity[offsets[c]:offsets[c + 1]]``; or ``(offsets, connectivity)``: all cells are elements then.
        vertices: method for the vertices: "auto" or the name of one of `methods`.
        elements: method for the elements, the cells of the highest dimension: "auto" or one of ``methods("elements")``.
            Cells of lower dimension are ordered by "lexmax", or stay with "original". Every cell stays in its block.
        vertex_count: the number of vertices, if there are no points.
        **options: see `Options`.

    Returns:
        The orders of the vertices and of all cells.

    Raises:
        InvalidArgument: faulty cells or points, an unknown method, sizes that do not match.
        TooLarge: 2³¹ or more vertices or cells.
        Unavailable: this build lacks a method.
        Stopped: ``progress`` returned False.

    Example:
        A simulator orders its own arrays before the first step::

            order = meshorder.order_mesh(points, {"tetra": tetrahedra})
            vertices, cells = order.vertices.permutation, order.cells.permutation
            points, velocities = vertices.move(points), vertices.move(velocities)
            tetrahedra = cells.move(vertices.renumber(tetrahedra))
    """
    if cells is None:
        return host_of(points).order(vertices, elements, options)
    return order_arrays(points, cells, vertices, elements, vertex_count, options)


def reorder(
    mesh: Any, *, vertices: str = "auto", elements: str = "auto", group_by: str | None = None, ids: str = "renumber",
    format: str | None = None, inplace: bool = False, **options: Any,
) -> tuple[Any, MeshOrder]:  # fmt: skip
    """Orders a mesh and moves its vertices and cells with their data, sets and groups.

    Args:
        mesh: a `Mesh`; a mesh of meshio, PyVista, VTK (vtkUnstructuredGrid, vtkPolyData), scikit-fem or trimesh;
            ``gmsh.model``; or a tuple of arrays, ``(points, cells)``, ``(points, cells, point_data)`` or
            ``(points, cells, point_data, cell_data)``. The cells have a form that `order_mesh` takes, the data are
            dicts of arrays with a row for each point or cell; if cells are in blocks, an entry of ``cell_data`` has
            an array for each block. Or a graph: an edge_index or sparse tensor of PyTorch, or a Data, HeteroData or Batch
            of PyTorch Geometric, with all values of its nodes, edges and faces.
        vertices: method for the vertices: "auto" or the name of one of `methods`.
        elements: method for the elements, the cells of the highest dimension: "auto" or one of ``methods("elements")``.
            With "auto", edges of a graph are sorted by their new target, then source; with "original", they stay.
        group_by: name of an array of whole numbers on cells or vertices: cells and vertices with the same number stay
            together, groups ascend. Write "cells:NAME" or "vertices:NAME" if both have that array; "sets" groups by
            the sets of cells.
        ids: for a `Mesh` only, how the file's numbers of vertices and cells change: "renumber" (the
            same numbers, ascending along the new order), "keep" (each keeps its number) or "attach" (as "renumber", and
            arrays "original" hold the old numbers, or the old places from 0 if there are none).
        format: for a `Mesh` only, name of the format that it will be written in, as some formats group cells by type;
            None: the format that it was read from.
        inplace: True changes and returns the mesh itself, or the arrays of the tuple. Gmsh's model requires it;
            scikit-fem's meshes and tensors refuse it.
        **options: see `Options`.

    Returns:
        The mesh in its new order, of the same type, and its orders. For a graph, these are of its nodes, type after type,
        and of its edges, type after type, then its faces. A UserWarning names tensors for which name and shape do not
        show whether they belong to the nodes or faces.

    Raises:
        InvalidArgument: an object that is not a mesh or cannot be reordered, faulty arrays, an unknown method or array, a
            path (`read` makes a mesh of a file).
        TooLarge: 2³¹ or more vertices or cells.
        Unavailable: this build, or the mesh's library, lacks something that is needed.
        Stopped: ``progress`` returned False.

    Example:
        Data of the vertices that are kept outside the mesh are moved by the order::

            mesh, order = meshorder.reorder(meshio.read("dragon.vtu"), vertices="hilbert")
            temperature = order.vertices.permutation.move(temperature)
    """
    return host_of(mesh).reorder(Request(vertices, elements, group_by, ids, format, inplace, options))
