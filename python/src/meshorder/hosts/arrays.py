# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Meshes given as tuples of the caller's arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import integers
from .._arrays import points as as_points
from .._errors import InvalidArgument
from .._meshes import MeshOrder
from .._permutation import Permutation
from .host import Host, moved_data, moved_rows, parts


class ArrayMesh(Host):
    """``(points, cells)``, ``(points, cells, point_data)`` or ``(points, cells, point_data, cell_data)``.

    The data are dicts of arrays. Those of ``cell_data`` have the form of the cells: if the cells are a dict or list
    of blocks, a dict or list with an array for each block, else one array with a row for each cell.
    """

    def __init__(self, mesh: tuple[Any, ...]) -> None:
        self.given = mesh
        self.points = as_points(mesh[0])
        self.cells = _with_types(mesh[1])
        self._data: list[Any] = list(mesh[2:])
        for data, name in zip(self._data, ("point_data", "cell_data")):
            if not isinstance(data, Mapping):
                raise InvalidArgument(f"{name}: expected a dict of arrays, not {type(data).__name__}")
        self._blocks = [integers(rows, "cells", rank=2) for rows in _blocks(self.cells)]
        self._sizes = [len(rows) for rows in self._blocks]

    def point_data(self) -> Mapping[str, Any]:
        return self._data[0] if self._data else {}

    def cell_data(self) -> Mapping[str, Any]:
        data = self._data[1] if len(self._data) > 1 else {}
        if self._sizes:
            return {name: np.concatenate(self._values_of_blocks(values, name)) for name, values in data.items()}
        return data

    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        if inplace:
            _check_writeable(self.given, "mesh")
        vertices, cells = order.vertices.permutation, order.cells.permutation
        moved = [vertices.move(np.asarray(self.given[0])), self._moved_cells(vertices, cells)]
        if self._data:
            moved.append({name: moved_data(vertices, values, name) for name, values in self._data[0].items()})
        if len(self._data) > 1:
            moved.append({name: self._cell_rows(cells, values, name) for name, values in self._data[1].items()})
        if inplace:
            _copy_into(self.given, moved)
            return self.given
        return tuple(moved)

    def _moved_cells(self, vertices: Permutation, cells: Permutation) -> Any:
        if not self._sizes:
            return self._moved_rows_of_any_size(vertices, cells)
        new = [vertices.renumber(part.move(rows)) for rows, part in zip(self._blocks, parts(cells, self._sizes))]
        if isinstance(self.cells, Mapping):
            return dict(zip(self.cells, new))
        if _is_list_of_blocks(self.cells):
            return type(self.cells)((name, rows) for (name, _), rows in zip(self.cells, new))
        return new[0]

    def _moved_rows_of_any_size(self, vertices: Permutation, cells: Permutation) -> Any:
        offsets, connectivity = integers(self.cells[0], "offsets"), integers(self.cells[1], "connectivity")
        new_offsets, entries = moved_rows(offsets, connectivity, cells)
        new: list[Any] = [new_offsets, vertices.renumber(entries)]
        new += [None if part is None else cells.move(np.asarray(part)) for part in self.cells[2:]]
        return tuple(new)

    def _cell_rows(self, cells: Permutation, values: Any, name: str) -> Any:
        if not self._sizes:
            return moved_data(cells, values, name)
        blocks = self._values_of_blocks(values, name)
        new = [part.move(block) for block, part in zip(blocks, parts(cells, self._sizes))]
        if isinstance(values, Mapping):
            return dict(zip(values, new))
        return new if isinstance(values, list) and _is_list_of_blocks(self.cells) else new[0]

    def _values_of_blocks(self, values: Any, name: str) -> list[NDArray[Any]]:
        """Returns the values of each block of cells."""
        if isinstance(values, Mapping):
            fits = isinstance(self.cells, Mapping) and list(values) == list(self.cells)
            blocks = list(values.values())
        elif isinstance(values, list) and _is_list_of_blocks(self.cells):
            fits, blocks = True, values
        else:
            fits, blocks = len(self._sizes) == 1, [values]
        arrays = [np.asarray(block) for block in blocks]
        if not fits or [array.shape[:1] for array in arrays] != [(size,) for size in self._sizes]:
            raise InvalidArgument(f"cell_data '{name}': expected blocks of {self._sizes} rows, one for each cell")
        return arrays


def _check_writeable(part: Any, name: str) -> None:
    if isinstance(part, Mapping):
        for key, inner in part.items():
            _check_writeable(inner, str(key))
    elif isinstance(part, (list, tuple)):
        for inner in part:
            _check_writeable(inner, name)
    elif part is not None and not isinstance(part, str):
        if not isinstance(part, np.ndarray) or not part.flags.writeable:
            raise InvalidArgument(f"inplace: {name} must be made of NumPy arrays that are writeable")


def _copy_into(part: Any, moved: Any) -> None:
    if isinstance(part, np.ndarray):
        part[...] = moved
    elif isinstance(part, Mapping):
        for key, inner in part.items():
            _copy_into(inner, moved[key])
    elif isinstance(part, (list, tuple)):
        for inner, moved_inner in zip(part, moved):
            _copy_into(inner, moved_inner)


def _with_types(cells: Any) -> Any:
    """Returns meshio's blocks of cells as pairs of type and data; other cells unchanged."""
    if isinstance(cells, list) and cells and all(hasattr(block, "type") and hasattr(block, "data") for block in cells):
        return [(block.type, block.data) for block in cells]
    return cells


def _is_list_of_blocks(cells: Any) -> bool:
    return (
        isinstance(cells, (list, tuple))
        and len(cells) > 0
        and all(isinstance(block, tuple) and len(block) == 2 and isinstance(block[0], str) for block in cells)
    )


def _blocks(cells: Any) -> list[Any]:
    """Returns the rows of each block of cells; an empty list for cells given by offsets and connectivity."""
    if isinstance(cells, Mapping):
        return list(cells.values())
    if _is_list_of_blocks(cells):
        return [rows for _, rows in cells]
    if isinstance(cells, tuple) and 2 <= len(cells) <= 3:
        return []
    return [cells]


def host(mesh: Any) -> Host | None:
    """Returns the host of a tuple of arrays that begins with points; None for other objects, such as ``(indptr, indices)``."""
    if not isinstance(mesh, tuple) or not 2 <= len(mesh) <= 4:
        return None
    first = mesh[0]
    if isinstance(first, (list, tuple)):
        first = first[0] if first else None
        is_table = isinstance(first, (list, tuple, np.ndarray))
    else:
        is_table = getattr(first, "ndim", 0) == 2
    return ArrayMesh(mesh) if is_table else None
