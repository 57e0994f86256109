# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""A meshio.Mesh as a .vtu file, for the command to work on, and back.

Sets are arrays "set:NAME" there, as in all .vtu files of meshorder's: 0, or the rank of a member in its set, from 1.
"""

from __future__ import annotations

import enum
from collections.abc import Iterable
from typing import Any
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from ._errors import InputError

_PREFIX = "set:"


def pack(mesh: Any, path: str, source: str) -> list[str]:
    """Writes a mesh as a .vtu file.

    Args:
        mesh: a meshio.Mesh.
        path: of the .vtu file.
        source: the mesh's own file, for messages.

    Returns:
        What is left out.

    Raises:
        InputError: cells that a .vtu file cannot hold.
    """
    import meshio
    from meshio._vtk_common import meshio_to_vtk_type

    notes: list[str] = []
    blocks = [k for k, block in enumerate(mesh.cells) if len(block.data)]
    for k in blocks:
        name = mesh.cells[k].type
        if name.startswith("polyhedron") or name not in meshio_to_vtk_type:
            raise InputError(f"{source}: holds {len(mesh.cells[k].data)} cells of type {name}, which cannot be ordered")

    point_data = {name: np.asarray(values) for name, values in mesh.point_data.items()}
    cell_data = {
        name: np.concatenate([np.asarray(values[k]) for k in blocks]) if blocks else np.empty(0)
        for name, values in mesh.cell_data.items()
    }
    for name, members in mesh.point_sets.items():
        point_data[_PREFIX + name] = _ranks(len(mesh.points), members)
    sizes = [len(block.data) for block in mesh.cells]
    for name, by_block in mesh.cell_sets.items():
        members = [
            np.asarray(part, dtype=np.int64) + begin
            for part, begin in zip(by_block, np.cumsum([0, *sizes]))
            if part is not None
        ]
        cell_data[_PREFIX + name] = _ranks(sum(sizes), np.concatenate(members) if members else [])

    cells = [(mesh.cells[k].type, np.asarray(mesh.cells[k].data, dtype=np.int64)) for k in blocks]
    begins = np.cumsum([0, *(len(vertices) for _, vertices in cells)])[1:-1]
    meshio.Mesh(
        _three_coordinates(mesh.points),
        cells,
        _in_vtk_types(point_data, "point data", source, notes),
        {
            name: np.split(values, begins)
            for name, values in _in_vtk_types(cell_data, "cell data", source, notes).items()
        },
    ).write(path, file_format="vtu", compression=None, header_type="UInt64")
    return notes


class Blocks(enum.Enum):
    """Which cells are put together in one block."""

    #: those of a type that follow each other
    AS_THEY_COME = enum.auto()
    #: those of a type among cells of one dimension that follow each other
    OF_TYPES_IN_RUNS = enum.auto()
    #: all of a type
    OF_TYPES = enum.auto()


def unpack(path: str, blocks: Blocks) -> tuple[Any, NDArray[np.intp]]:
    """The mesh of a .vtu file as a meshio.Mesh.

    Args:
        path: of the .vtu file.
        blocks: into which cells are put together.

    Returns:
        The mesh, and for each cell its place in the .vtu file.
    """
    import meshio
    from meshio._mesh import topological_dimension

    mesh = meshio.read(path, file_format="vtu")
    keys = [(k, block.type) for k, block in enumerate(mesh.cells)]
    if blocks is Blocks.OF_TYPES_IN_RUNS:
        dimensions = [topological_dimension[block.type] for block in mesh.cells]
        runs = np.cumsum(np.diff(dimensions, prepend=0) != 0).tolist()
        keys = [(run, block.type) for run, block in zip(runs, mesh.cells)]
    elif blocks is Blocks.OF_TYPES:
        keys = [(0, block.type) for block in mesh.cells]
    found = list(dict.fromkeys(keys))
    block_of = [found.index(key) for key in keys]
    order = np.argsort(np.repeat(block_of, [len(block.data) for block in mesh.cells]), kind="stable")

    def joined(by_block: Iterable[Any]) -> list[Any]:
        parts: list[list[Any]] = [[] for _ in found]
        for part, block in zip(by_block, block_of):
            parts[block].append(part)
        return [np.concatenate(part) for part in parts]

    cell_data = {name: joined(by_block) for name, by_block in mesh.cell_data.items()}
    point_sets = {name: _members(mesh.point_data.pop(name)) for name in _names_of_sets(mesh.point_data)}
    cell_sets = {name: [_members(ranks) for ranks in cell_data.pop(name)] for name in _names_of_sets(cell_data)}
    made = meshio.Mesh(
        mesh.points,
        list(zip([name for _, name in found], joined(block.data for block in mesh.cells))),
        mesh.point_data,
        cell_data,
        point_sets={name.removeprefix(_PREFIX): members for name, members in point_sets.items()},
        cell_sets={name.removeprefix(_PREFIX): members for name, members in cell_sets.items()},
    )
    return made, order


def _names_of_sets(data: dict[str, Any]) -> list[str]:
    return [name for name in data if name.startswith(_PREFIX)]


def _ranks(count: int, members: Any) -> NDArray[np.int32]:
    members = np.asarray(members, dtype=np.int64)
    firsts = np.sort(np.unique(members, return_index=True)[1])
    ranks = np.zeros(count, dtype=np.int32)
    ranks[members[firsts]] = np.arange(1, len(firsts) + 1)
    return ranks


def _members(ranks: NDArray[Any]) -> NDArray[np.intp]:
    members = np.flatnonzero(ranks)
    return members[np.argsort(ranks[members], kind="stable")]


def _three_coordinates(points: Any) -> NDArray[Any]:
    points = np.asarray(points)
    if points.dtype != np.float32:
        points = points.astype(np.float64, copy=False)
    return np.pad(points, ((0, 0), (0, 3 - points.shape[1])))


def _in_vtk_types(data: dict[str, Any], what: str, source: str, notes: list[str]) -> dict[str, Any]:
    """The arrays that a .vtu file holds, under names that may stand in it."""
    held = {}
    for name, values in data.items():
        if values.dtype.kind not in "biuf":
            notes.append(f"{source}: the {what} {name} of type {values.dtype} is left out")
            continue
        if values.dtype.kind == "b":
            values = values.astype(np.uint8)
        elif values.dtype.kind == "f" and values.dtype.itemsize not in (4, 8):
            values = values.astype(np.float64)
        if values.ndim > 2:
            values = values.reshape(len(values), -1)
            notes.append(f"{source}: the {what} {name} becomes rows of {values.shape[1]} numbers")
        # meshio writes names as they are
        held[escape(name, {'"': "&quot;"}).encode("ascii", "xmlcharrefreplace").decode()] = np.ascontiguousarray(values)
    return held
