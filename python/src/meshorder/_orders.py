# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders of graphs, matrices and meshes, those of other libraries among them."""

from __future__ import annotations

from typing import Any

from ._errors import InvalidArgument
from ._graphs import Order, order_graph
from ._meshes import MeshOrder, order_arrays
from .hosts import find_host, host_of
from .hosts.host import Request


def order(
    graph: Any, method: str = "auto", *, points: Any = None, weights: Any = None, **options: Any
) -> Order:
    """New places for the vertices of a graph, or the rows and columns of a matrix.

    Args:
        graph: a square SciPy matrix (CSR is read in place, others are converted), ``(indptr, indices)``, a networkx
            graph (vertices in the order of its nodes) or a torch matrix in CSR form; or a mesh as of `reorder`, whose
            vertices are ordered. Diagonals are ignored.
        method: "auto" or one of `methods`.
        points: coordinates, for geometric methods.
        weights: > 0, one for each entry of the graph, equal on both sides of the diagonal.
        **options: see `Options`.

    Raises:
        InvalidArgument: a faulty graph, an unknown method, sizes that do not match.
        TooLarge: 2³¹ or more vertices.
        Stopped: ``progress`` returned False.
    """
    host = find_host(graph)
    if host is None:
        return order_graph(graph, method, points, weights, options)
    if points is not None or weights is not None:
        raise InvalidArgument("order: a mesh has points of its own, and no weights")
    return host.order(method, "original", options).vertices


def order_mesh(
    points: Any, cells: Any = None, *, vertices: str = "auto", elements: str = "auto", vertex_count: int | None = None,
    **options: Any,
) -> MeshOrder:  # fmt: skip
    """New places for the vertices of a mesh and for its cells. Nothing is changed.

    Args:
        points: one row of one to three coordinates for each vertex; or None, with ``vertex_count``; or, without
            cells, a mesh as of `reorder`.
        cells: an array with a row for each cell (2 or 3 vertices; in space 6, 8 or 10; 4 are tetrahedra in space and quads
            in the plane), ``{type: array}``, ``[(type, array), …]`` with meshio's names of types, or ``(offsets, connectivity)``
            with VTK's types as a third. Cells are numbered in the order in which they are given.
        vertices: method for the vertices.
        elements: method for the elements, the cells of the highest dimension.
        vertex_count: where there are no points.
        **options: see `Options`.

    Raises:
        InvalidArgument: faulty cells or points, an unknown method.
    """
    if cells is None:
        return host_of(points).order(vertices, elements, options)
    return order_arrays(points, cells, vertices, elements, vertex_count, options)


def reorder(
    mesh: Any, *, vertices: str = "auto", elements: str = "auto", group_by: str | None = None, ids: str = "renumber",
    format: str | None = None, inplace: bool = False, **options: Any,
) -> tuple[Any, MeshOrder]:  # fmt: skip
    """Orders a mesh and moves its vertices and cells, with all data, sets and groups that belong to them.

    Args:
        mesh: a `Mesh`; a mesh of meshio, PyVista, VTK (vtkUnstructuredGrid, vtkPolyData), scikit-fem or trimesh;
            ``gmsh.model``; or a tuple of arrays: ``(points, cells)`` with cells as of `order_mesh`, and then, where
            there are any, a dict of arrays of the points and one of the cells (for cells in blocks, of an array for
            each block).
        vertices: method for the vertices.
        elements: method for the elements.
        group_by: name of an array of whole numbers whose groups stay together, or "sets" for the sets of cells.
        ids: of a `Mesh`: "renumber", "keep" or "attach".
        format: of a `Mesh`: the one that it will be written in; None: the one it was read from.
        inplace: changes the mesh itself, and of a tuple its arrays.
        **options: see `Options`.

    Returns:
        The mesh in its new order, of the same type, and the order.

    Raises:
        InvalidArgument: what is no mesh, or none that can be moved; faulty arrays; an unknown method or array.
    """
    return host_of(mesh).reorder(Request(vertices, elements, group_by, ids, format, inplace, options))
