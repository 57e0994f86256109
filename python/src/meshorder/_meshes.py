# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Meshes: arrays, files, and what is said of an order before it is made."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core, _html
from ._arrays import integers
from ._arrays import points as as_points
from ._errors import InvalidArgument
from ._graphs import Order
from ._options import prepared

#: names of shapes, by the library's number
SHAPES: tuple[str, ...] = _core.shapes
_SHAPE_OF = {name: name for name in SHAPES} | {"tetra": "tetrahedron", "hexa": "hexahedron", "prism": "wedge"}


@dataclass(frozen=True, eq=False)
class MeshOrder:
    """Orders of a mesh's vertices and of all its cells."""

    vertices: Order
    cells: Order

    @classmethod
    def _of(cls, made: tuple[dict[str, Any], dict[str, Any]]) -> MeshOrder:
        return cls(Order._of(made[0]), Order._of(made[1]))

    def __repr__(self) -> str:
        return f"<MeshOrder: vertices {self.vertices!r}, cells {self.cells!r}>"

    def _repr_html_(self) -> str:
        return _html.mesh_order(self)


def _shape(type_name: Any) -> str:
    shape = _SHAPE_OF.get(re.sub(r"\d+$", "", str(type_name)))
    if shape is None:
        raise InvalidArgument(f"cells: unknown type {type_name!r}; known are {', '.join(SHAPES)} and meshio's names")
    return shape


def _block(type_name: Any, vertices: Any) -> tuple[str, NDArray[Any]]:
    return _shape(type_name), integers(vertices, f"cells of type {type_name}", rank=2)


_SIMPLEX = {2: "line", 3: "triangle", 6: "wedge", 8: "hexahedron", 10: "tetrahedron"}


def cell_arrays(cells: Any, dimension: int) -> Any:
    """Cells in the form that the library takes: blocks, or offsets, vertices and VTK's types."""
    if isinstance(cells, Mapping):
        return [_block(name, vertices) for name, vertices in cells.items()]
    if isinstance(cells, tuple) and 2 <= len(cells) <= 3 and not isinstance(cells[0], str):
        types = None
        if len(cells) == 3 and cells[2] is not None:
            types = np.ascontiguousarray(cells[2], dtype=np.uint8)
        return integers(cells[0], "offsets"), integers(cells[1], "connectivity"), types
    if isinstance(cells, (list, tuple)) and cells and not isinstance(cells[0], (list, np.ndarray)):
        if hasattr(cells[0], "type"):  # meshio's blocks
            return [_block(block.type, block.data) for block in cells]
        if isinstance(cells[0], tuple) and len(cells[0]) == 2 and isinstance(cells[0][0], str):
            return [_block(*block) for block in cells]
    vertices = integers(cells, "cells", rank=2)
    width = vertices.shape[1]
    name = _SIMPLEX.get(width) if width != 4 else "tetrahedron" if dimension == 3 else "quad"
    if name is None or (width == 6 and dimension == 2):
        raise InvalidArgument(f"cells: {width} vertices each may be several types; name it, as in {{'triangle6': cells}}")
    return [(name, vertices)]


def order_mesh(
    points: Any, cells: Any = None, *, vertices: str = "auto", elements: str = "auto", vertex_count: int | None = None,
    **options: Any,
) -> MeshOrder:  # fmt: skip
    """New places for the vertices of a mesh and for its cells. Nothing is changed.

    Args:
        points: one row of one to three coordinates for each vertex; or None, with ``vertex_count``; or, without
            cells, a mesh as of `reorder`.
        cells: an array with a row for each cell (2, 3, 8 or 10 vertices; 4 are tetrahedra in space and quads in the
            plane), ``{type: array}``, ``[(type, array), …]`` with meshio's names of types, or ``(offsets, connectivity)``
            with VTK's types as a third. Cells are numbered in the order in which they are given.
        vertices: method for the vertices.
        elements: method for the elements, the cells of the highest dimension.
        vertex_count: where there are no points.
        **options: see `Options`.

    Raises:
        InvalidArgument: faulty cells or points, an unknown method.
    """
    if cells is None:
        from .hosts import host_of  # which needs this module

        return host_of(points).order(vertices, elements, options)
    coordinates = None if points is None else as_points(points)
    if coordinates is None and vertex_count is None:
        raise InvalidArgument("order_mesh: without points vertex_count must be given")
    arrays = cell_arrays(cells, 3 if coordinates is None else coordinates.shape[1])
    with prepared(options) as given:
        return MeshOrder._of(_core.order_mesh(coordinates, arrays, vertex_count or 0, vertices, elements, given))


class Mesh:
    """A mesh of a file, with all its data. `read` makes it, and `make_mesh` from arrays."""

    __slots__ = ("_handle", "notes")

    def __init__(self, made: _core.Mesh, notes: list[str] | None = None) -> None:
        self._handle = made
        #: what the reader dropped or repaired
        self.notes = notes or []

    @property
    def points(self) -> NDArray[np.float64]:
        """Three coordinates for each vertex; a view."""
        return self._handle.points

    @property
    def offsets(self) -> NDArray[np.int64]:
        """Cell c has the vertices ``connectivity[offsets[c]:offsets[c + 1]]``; a view."""
        return self._handle.offsets

    @property
    def connectivity(self) -> NDArray[np.int32]:
        """The vertices of the cells, one cell after another; a view."""
        return self._handle.connectivity

    @property
    def shapes(self) -> NDArray[np.uint8]:
        """The number of each cell's shape, in the order of the C++ enumeration ``Shape``; a view."""
        return self._handle.shapes

    @property
    def cells(self) -> list[tuple[str, NDArray[np.int32]]]:
        """Runs of cells of one type, in the order of the file: its shape and a row of vertices for each cell."""
        widths = np.diff(self.offsets)
        kinds = np.stack([self.shapes.astype(np.int64), widths])
        changes = (np.diff(kinds, axis=1) != 0).any(axis=0)
        begins = [0, *(np.flatnonzero(changes) + 1)] if len(widths) else []
        runs = []
        for begin, end in zip(begins, [*begins[1:], len(widths)]):
            rows = self.connectivity[self.offsets[begin] : self.offsets[end]]
            runs.append((SHAPES[self.shapes[begin]], rows.reshape(end - begin, -1)))
        return runs

    @property
    def point_data(self) -> dict[str, Any]:
        """Arrays with a row for each vertex."""
        return self._data(True)

    @property
    def cell_data(self) -> dict[str, Any]:
        """Arrays with a row for each cell."""
        return self._data(False)

    def _data(self, of_vertices: bool) -> dict[str, Any]:
        return {
            name: values
            for name, vertices, values, indices in self._handle.data
            if vertices == of_vertices and len(indices) == 0
        }

    @property
    def sets(self) -> dict[str, NDArray[np.int32]]:
        """Named lists of vertices or cells."""
        return {name: members for name, _, members in self._handle.sets}

    @property
    def vertex_ids(self) -> NDArray[np.int64]:
        """The file's numbers of the vertices; empty where these are their places."""
        return self._handle.vertex_ids

    @property
    def cell_ids(self) -> NDArray[np.int64]:
        """Likewise of the cells."""
        return self._handle.cell_ids

    @property
    def format(self) -> str:
        """The format that the mesh was read from."""
        return self._handle.format

    def copy(self) -> Mesh:
        """A mesh of its own with the same contents."""
        return Mesh(self._handle.copy(), list(self.notes))

    def __repr__(self) -> str:
        return f"<Mesh: {len(self.points):,} vertices, {len(self.shapes):,} cells{f', {self.format}' if self.format else ''}>"

    def _repr_html_(self) -> str:
        return _html.mesh(self)


def read(source: str | os.PathLike[str] | bytes, format: str | None = None) -> Mesh:
    """Reads a mesh from a file, or from the bytes of one.

    Args:
        source: a path or the bytes.
        format: name of the format; None: by the extension, of bytes by the first of them. Files of formats that are not
            ours are read by meshio, where it is installed; the mesh's notes begin with that.

    Raises:
        InputError: the file is missing or faulty; the message names line or byte.
    """
    if isinstance(source, (bytes, bytearray, memoryview)):
        return Mesh(*_core.read_bytes(bytes(source), format or ""))
    from . import _foreign  # which needs this module

    path = os.fspath(source)
    foreign = _foreign.format_of_meshio(path, format or "")
    return _foreign.read(path, foreign) if foreign else Mesh(*_core.read(path, format or ""))


def write(mesh: Any, path: str | os.PathLike[str]) -> list[str]:
    """Writes a mesh as of `reorder` in the format that the extension names; by meshio where it is not ours.

    Returns:
        What was left out, of a mesh that is no `Mesh` also on the way to one; and that meshio wrote, if it did.
    """
    from . import _foreign  # which needs this module

    if not isinstance(mesh, Mesh):
        made = make_mesh(mesh)
        return made.notes + write(made, path)
    foreign = _foreign.format_of_meshio(os.fspath(path))
    if foreign:
        return _foreign.write(mesh, os.fspath(path), foreign)
    notes: list[str] = mesh._handle.write(os.fspath(path))
    return notes


def to_bytes(mesh: Any, format: str) -> bytes:
    """The bytes of the file that `write` would make, in a format of our own."""
    made: bytes = (mesh if isinstance(mesh, Mesh) else make_mesh(mesh))._handle.to_bytes(format, "mesh")
    return made


def make_mesh(points: Any, cells: Any = None) -> Mesh:
    """A mesh of arrays as of `order_mesh`, which are copied.

    Without cells: of a mesh as of `reorder`, with its data and sets; the notes tell what was left out.
    """
    if cells is None:
        from .hosts import host_of  # which needs this module

        return host_of(points).mesh()
    coordinates = as_points(points)
    return Mesh(_core.make_mesh(coordinates, cell_arrays(cells, coordinates.shape[1])))


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
    from .hosts import host_of  # which needs this module
    from .hosts.host import Request

    return host_of(mesh).reorder(Request(vertices, elements, group_by, ids, format, inplace, options))
