# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Meshes with all their data, and orders of arrays of cells."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from . import _core, _html
from ._arrays import integers
from ._arrays import points as as_points
from ._errors import InvalidArgument
from ._graphs import Order
from ._options import prepared, whole
from ._permutation import Permutation

#: names of shapes, by the library's number
SHAPES: tuple[str, ...] = _core.shapes
_SHAPE_OF = {name: name for name in SHAPES} | {"tetra": "tetrahedron", "hexa": "hexahedron", "prism": "wedge"}
_ORDERS = range(1, 11)
#: for each shape, the numbers of vertices that its name alone can mean: those of complete cells, and other usual ones
_WIDTHS = {
    "line": {p + 1 for p in _ORDERS},
    "triangle": {(p + 1) * (p + 2) // 2 for p in _ORDERS} | {7},
    "quad": {(p + 1) ** 2 for p in _ORDERS} | {8},
    "tetrahedron": {(p + 1) * (p + 2) * (p + 3) // 6 for p in _ORDERS} | {11, 14, 15},
    "hexahedron": {(p + 1) ** 3 for p in _ORDERS} | {20, 24},
    "wedge": {(p + 1) ** 2 * (p + 2) // 2 for p in _ORDERS} | {12, 15, 20, 21},
    "pyramid": {(p + 1) * (p + 2) * (2 * p + 3) // 6 for p in _ORDERS} | {13, 18, 19},
}


@dataclass(frozen=True, eq=False)
class MeshOrder:
    """Orders of a mesh's vertices and of all its cells."""

    vertices: Order
    cells: Order

    @classmethod
    def _of(cls, made: tuple[dict[str, Any], dict[str, Any]]) -> MeshOrder:
        return cls(Order._of(made[0]), Order._of(made[1]))

    def __getattr__(self, name: str) -> NoReturn:
        if not name.startswith("_") and (name in Order.__annotations__ or hasattr(Permutation, name)):
            raise AttributeError(f"a MeshOrder has no {name!r}: use that of its .vertices or .cells")
        raise AttributeError(f"'MeshOrder' object has no attribute {name!r}")

    def __repr__(self) -> str:
        return f"<MeshOrder: vertices {self.vertices!r}, cells {self.cells!r}>"

    def _repr_html_(self) -> str:
        return _html.mesh_order(self)


def _shape(type_name: Any) -> str:
    shape = _SHAPE_OF.get(re.sub(r"\d+$", "", str(type_name)))
    if shape is None:
        raise InvalidArgument(f"cells: unknown type {type_name!r}; known: {', '.join(SHAPES)} and meshio's names")
    return shape


def _block(type_name: Any, vertices: Any) -> tuple[str, NDArray[Any]]:
    shape = _shape(type_name)
    rows = integers(vertices, f"cells of type {type_name}", rank=2)
    width = rows.shape[1]
    number = re.search(r"\d+$", str(type_name))
    wanted = {int(number[0])} if number else _WIDTHS.get(shape, {width})
    if len(rows) and width not in wanted:
        transposed = ", or the array is transposed" if len(rows) in wanted else ""
        raise InvalidArgument(
            f"cells of type {type_name}: each row has {width} vertices, expected {min(wanted)}; "
            f"cells of another kind need its name, as in 'triangle6'{transposed}"
        )
    return shape, rows


def _vtk_types(values: Any) -> NDArray[np.uint8]:
    if isinstance(values, np.ndarray) and values.dtype == np.uint8 and values.ndim == 1:
        return np.ascontiguousarray(values)
    types = integers(values, "VTK's types")
    if types.size and not 0 <= types.min() <= types.max() <= 255:
        wrong = types[(types < 0) | (types > 255)][0]
        raise InvalidArgument(f"cells: a cell has the VTK type {wrong}, which is not supported")
    return types.astype(np.uint8)


_SIMPLEX = {2: "line", 3: "triangle", 6: "wedge", 8: "hexahedron", 10: "tetrahedron"}


def cell_arrays(cells: Any, dimension: int) -> Any:
    """Returns cells in the form that the library takes: blocks, or offsets, vertices and VTK's types."""
    if isinstance(cells, Mapping):
        return [_block(name, vertices) for name, vertices in cells.items()]
    if isinstance(cells, tuple) and 2 <= len(cells) <= 3 and not isinstance(cells[0], str):
        types = None if len(cells) == 2 or cells[2] is None else _vtk_types(cells[2])
        return integers(cells[0], "offsets"), integers(cells[1], "connectivity"), types
    if isinstance(cells, (list, tuple)) and len(cells) == 0:
        return []
    if isinstance(cells, (list, tuple)) and not isinstance(cells[0], (list, np.ndarray)):
        if hasattr(cells[0], "type"):  # meshio's blocks
            return [_block(block.type, block.data) for block in cells]
        if isinstance(cells[0], tuple) and len(cells[0]) == 2 and isinstance(cells[0][0], str):
            return [_block(*block) for block in cells]
    vertices = integers(cells, "cells", rank=2)
    width = vertices.shape[1]
    name = _SIMPLEX.get(width) if width != 4 else "tetrahedron" if dimension == 3 else "quad"
    if name is None or (dimension < 3 and width > 4):
        remedy = f"this does not say the type; name it, as in {{'triangle6': cells}}"
        if len(vertices) in {4, *_SIMPLEX}:
            remedy = "is the array transposed? A row for each cell is expected"
        raise InvalidArgument(f"cells: {width} vertices each: {remedy}")
    return [(name, vertices)]


def order_arrays(
    points: Any, cells: Any, vertices: str, elements: str, vertex_count: int | None, options: dict[str, Any]
) -> MeshOrder:
    """Orders a mesh that is given as arrays; see `order_mesh`."""
    coordinates = None if points is None else as_points(points)
    if coordinates is None and vertex_count is None:
        raise InvalidArgument("order_mesh: without points vertex_count must be given")
    count = 0 if vertex_count is None else whole(vertex_count, 2**63 - 1, "vertex_count")
    arrays = cell_arrays(cells, 3 if coordinates is None else coordinates.shape[1])
    with prepared(options) as given:
        return MeshOrder._of(_core.order_mesh(coordinates, arrays, count, vertices, elements, given))


class Mesh:
    """A mesh with all data of its file. `read` makes it from a file, `make_mesh` from arrays.

    Arrays that were taken from a mesh keep their values when it is reordered in place.
    """

    __slots__ = ("_handle", "notes")

    def __init__(self, made: _core.Mesh, notes: list[str] | None = None) -> None:
        self._handle = made
        #: notes on what the reader dropped or repaired
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
        """Consecutive cells of one type, in the order of the file: for each run its shape and a row of vertices for each cell."""
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
        """Named lists of vertices or cells; "vertices:NAME" and "cells:NAME" if both have a set of that name."""
        sets = self._handle.sets
        count_of = Counter(name for name, _, _ in sets)
        return {
            name if count_of[name] == 1 else f"{'vertices' if of_vertices else 'cells'}:{name}": members
            for name, of_vertices, members in sets
        }

    @property
    def vertex_ids(self) -> NDArray[np.int64]:
        """The numbers of the vertices in the file; empty if these are their places."""
        return self._handle.vertex_ids

    @property
    def cell_ids(self) -> NDArray[np.int64]:
        """The numbers of the cells in the file; empty if these are their places."""
        return self._handle.cell_ids

    @property
    def format(self) -> str:
        """The format that the mesh was read from."""
        return self._handle.format

    def copy(self) -> Mesh:
        """Returns an independent mesh with the same contents."""
        return Mesh(self._handle.copy(), list(self.notes))

    def __repr__(self) -> str:
        return f"<Mesh: {len(self.points):,} vertices, {len(self.shapes):,} cells{f', {self.format}' if self.format else ''}>"

    def _repr_html_(self) -> str:
        return _html.mesh(self)


def mesh_of_arrays(points: Any, cells: Any) -> Mesh:
    """Makes a mesh from arrays; see `make_mesh`."""
    coordinates = as_points(points)
    return Mesh(_core.make_mesh(coordinates, cell_arrays(cells, coordinates.shape[1])))
