# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Meshes of meshio, and conversion of a `Mesh` to them."""

from __future__ import annotations

import copy
import enum
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._arrays import integers
from .._errors import InputError, InvalidArgument
from .._meshes import SHAPES, Mesh, MeshOrder
from .._permutation import Permutation
from .host import Host, moved_data, parts


#: the set of cells in which meshio's reader of Gmsh 4.1 stores the tags of the entities that bound each block. The sign
#: of a tag is the entity's orientation
_ENTITY_TAGS = "gmsh:bounding_entities"


class MeshioMesh(Host):
    """A meshio.Mesh. Cells stay within their block, so blocks keep their sizes.

    A set of cells has an array for each block, with numbers within the block, or None; arrays may be missing at the
    end. Some readers of meshio 5.3 make other sets, whose form and meaning are kept:

    - Gmsh 4.1: tags of entities among the sets;
    - Abaqus: a set that names other sets is a list of these, each with an array for each block;
    - FLAC3D: the numbers count the cells of all blocks.
    """

    def __init__(self, mesh: Any) -> None:
        self.given = mesh
        self.points = np.asarray(mesh.points)
        self.cells = mesh.cells or {}
        for block in mesh.cells:
            if block.type.startswith("polyhedron"):
                raise InvalidArgument("mesh: polyhedra of meshio cannot be ordered; PyVista's and VTK's can")
        self._starts = np.cumsum([0, *(len(block.data) for block in mesh.cells)])

    def point_data(self) -> Mapping[str, Any]:
        data: Mapping[str, Any] = self.given.point_data
        return data

    def cell_data(self) -> Mapping[str, Any]:
        return {name: _joined(blocks) for name, blocks in self.given.cell_data.items() if len(blocks) > 0}

    def point_sets(self) -> Mapping[str, Any]:
        sets: Mapping[str, Any] = self.given.point_sets
        return sets

    def cell_sets(self) -> Mapping[str, Any]:
        sets = {name: blocks for name, blocks in self.given.cell_sets.items() if name != _ENTITY_TAGS}
        starts = np.zeros_like(self._starts) if self._counts_all_cells() else self._starts
        return {
            name: np.concatenate(
                [
                    integers(members, f"set '{name}'").astype(np.int64) + start
                    for part in (blocks if _names_sets(blocks) else [blocks])
                    for members, start in zip(part, starts)
                    if members is not None
                ]
                or [np.zeros(0, dtype=np.int64)]
            )
            for name, blocks in sets.items()
        }

    def _counts_all_cells(self) -> bool:
        """Returns whether the sets are those of meshio's reader of FLAC3D, whose numbers count the cells of all blocks."""
        sets = self.given.cell_sets
        if "cell_ids" not in self.given.cell_data or not all(name.startswith(("zone:", "face:")) for name in sets):
            return False
        return all(
            members is None or np.all((start <= np.asarray(members)) & (np.asarray(members) < end))
            for blocks in sets.values()
            for members, start, end in zip(blocks, self._starts[:-1], self._starts[1:])
        )

    def mesh(self) -> Mesh:
        made = super().mesh()
        made.notes += [f"field data '{name}' was left out: a meshorder.Mesh has none" for name in self.given.field_data]
        if _ENTITY_TAGS in self.given.cell_sets:
            made.notes.append(f"'{_ENTITY_TAGS}' was left out: it holds tags of Gmsh, not cells")
        if self.given.gmsh_periodic:
            made.notes.append("Gmsh's periodic points were left out")
        if self.given.info is not None:
            made.notes.append("meshio's info was left out")
        return made

    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        mesh = self.given
        by_vertex = order.vertices.permutation
        by_cell = parts(order.cells.permutation, np.diff(self._starts).tolist())
        new = {
            "points": by_vertex.move(self.points),
            "point_data": {name: moved_data(by_vertex, values, name) for name, values in mesh.point_data.items()},
            "point_sets": {name: _renumbered(by_vertex.old_to_new, s, name) for name, s in mesh.point_sets.items()},
            "cells": [_moved_block(block, by_vertex, part) for block, part in zip(mesh.cells, by_cell)],
            "cell_data": {
                name: [moved_data(part, values, name) for values, part in zip(blocks, by_cell)]
                for name, blocks in mesh.cell_data.items()
            },
            "cell_sets": self._moved_cell_sets(by_cell),
            "gmsh_periodic": self._periodic(by_vertex.old_to_new),
        }
        # ids that meshio's reader of Nastran adds to the mesh
        if hasattr(mesh, "points_id"):
            new["points_id"] = by_vertex.move(np.asarray(mesh.points_id))
        if hasattr(mesh, "cells_id"):
            new["cells_id"] = [part.move(np.asarray(ids)) for ids, part in zip(mesh.cells_id, by_cell)]
        moved = mesh if inplace else copy.copy(mesh)
        for name, value in new.items():
            setattr(moved, name, value)
        if not inplace:
            moved.field_data = dict(mesh.field_data)
        return moved

    def _moved_cell_sets(self, by_cell: list[Permutation]) -> dict[str, Any]:
        starts = self._starts[:-1] if self._counts_all_cells() else np.zeros(len(by_cell), dtype=np.int64)

        def moved(blocks: Any, name: str) -> list[Any]:
            if _names_sets(blocks):
                return [moved(part, name) for part in blocks]
            if len(blocks) > len(by_cell):
                raise InvalidArgument(f"set '{name}' has {len(blocks)} arrays for {len(by_cell)} blocks of cells")
            return [
                None if members is None else _renumbered(part.old_to_new, members, name, start)
                for members, part, start in zip(blocks, by_cell, starts)
            ]

        return {
            name: blocks if name == _ENTITY_TAGS else moved(blocks, name)
            for name, blocks in self.given.cell_sets.items()
        }

    def _periodic(self, old_to_new: NDArray[Any]) -> Any:
        """Returns for each periodic entity [dimension, entities, transformation, pairs of points], with new numbers."""
        if not self.given.gmsh_periodic:
            return self.given.gmsh_periodic
        return [
            [*entity, _renumbered(old_to_new, np.asarray(pairs), "gmsh_periodic")]
            for *entity, pairs in self.given.gmsh_periodic
        ]


def _moved_block(block: Any, by_vertex: Permutation, by_cell: Permutation) -> Any:
    moved = copy.copy(block)
    moved.data = by_vertex.renumber(by_cell.move(np.asarray(block.data)))
    return moved


def _joined(blocks: Any) -> Any:
    """Returns the values of all blocks in one array, which is masked if a block is."""
    library: Any = np.ma if any(map(np.ma.is_masked, blocks)) else np
    return library.concatenate(blocks)


def _names_sets(blocks: Any) -> bool:
    """Returns whether a set of cells is a list of sets."""
    lists = [part for part in blocks if isinstance(part, (list, tuple))]
    return any(isinstance(members, (list, tuple, np.ndarray)) for part in lists for members in part)


def _renumbered(new_places: NDArray[Any], members: Any, name: str, first: int = 0) -> NDArray[Any]:
    """Returns the new numbers of the members of a set, in the type of the old ones; both count from ``first``.

    Raises:
        InvalidArgument: a member that does not exist.
    """
    given = integers(members, f"set '{name}'", rank=None)
    numbers = given.astype(np.int64) - first
    if numbers.size and (numbers.min() < 0 or numbers.max() >= len(new_places)):
        raise InvalidArgument(f"set '{name}' has a member outside {first} … {first + len(new_places) - 1}")
    renumbered: NDArray[Any] = (new_places[numbers] + first).astype(given.dtype)
    return renumbered


#: note of `to_meshio` that reports no loss
GROUPED = "cells were grouped by type"


class Blocks(enum.Enum):
    """Which cells of a `Mesh` become one block of meshio."""

    #: consecutive cells of one type
    AS_THEY_COME = enum.auto()
    #: all cells of one type among consecutive cells of one dimension
    OF_TYPES_IN_RUNS = enum.auto()
    #: all cells of one type
    OF_TYPES = enum.auto()


def to_meshio(mesh: Mesh, blocks: Blocks = Blocks.OF_TYPES) -> tuple[Any, NDArray[np.int64], list[str]]:
    """Makes a meshio.Mesh from a `Mesh`, with its data and sets.

    Returns:
        The meshio.Mesh; the old place of each of its cells, in their order; and notes on what it cannot hold.

    Raises:
        InputError: cells of a type that meshio does not have.
    """
    import meshio

    widths = np.diff(mesh.offsets)
    members = _members(mesh, widths, blocks)
    made_blocks = []
    for cells in members:
        width = widths[cells[0]]
        rows = mesh.connectivity[mesh.offsets[cells][:, np.newaxis] + np.arange(width)]
        try:
            made_blocks.append(meshio.CellBlock(_type_name(SHAPES[mesh.shapes[cells[0]]], int(width)), rows))
        except KeyError:
            name = f"{SHAPES[mesh.shapes[cells[0]]]} of {width} vertices"
            raise InputError(f"meshio has no cells of the type {name}") from None
    old_places = np.concatenate(members) if members else np.zeros(0, dtype=np.int64)
    notes = [] if (old_places == np.arange(len(widths))).all() else [GROUPED]
    points = mesh.points[:, : mesh._handle.dimension]
    made = meshio.Mesh(np.array(points), made_blocks)
    _attach(made, mesh, members, notes)
    if len(mesh.vertex_ids) or len(mesh.cell_ids):
        notes.append("the numbers of vertices and cells were left out")
    notes += [f"{content}: left out" for content in mesh._handle.format_contents]
    return made, old_places, notes


def _members(mesh: Mesh, widths: NDArray[Any], blocks: Blocks) -> list[NDArray[np.int64]]:
    """Returns the cells of each block; the blocks are sorted by their first cells."""
    if len(widths) == 0:
        return []
    kinds = np.stack([mesh.shapes.astype(np.int64), widths])
    run = np.zeros(len(widths), dtype=np.int64)
    if blocks is Blocks.AS_THEY_COME:
        run[1:] = np.cumsum((np.diff(kinds, axis=1) != 0).any(axis=0))
    elif blocks is Blocks.OF_TYPES_IN_RUNS:
        run[1:] = np.cumsum(np.diff(np.array(_core.dimensions)[mesh.shapes]) != 0)
    _, first, block_of = np.unique(np.vstack([run, kinds]), axis=1, return_index=True, return_inverse=True)
    cells = np.argsort(block_of.ravel(), kind="stable")
    ends = np.cumsum(np.bincount(block_of.ravel()))
    parts = np.split(cells, ends[:-1])
    return [parts[block] for block in np.argsort(first)]


def _attach(made: Any, mesh: Mesh, members: list[NDArray[Any]], notes: list[str]) -> None:
    """Adds data and sets to a meshio.Mesh whose blocks have these cells; notes name what is left out."""
    for name, of_vertices, values, indices in mesh._handle.data:
        if isinstance(values, list) or len(indices):
            why = "its values are texts" if isinstance(values, list) else "it has values for some only"
            notes.append(f"{'point' if of_vertices else 'cell'} data '{name}' was left out: {why}")
        elif of_vertices:
            made.point_data[name] = np.array(values)
        else:
            made.cell_data[name] = [values[cells] for cells in members]
    places = np.empty(len(mesh.shapes), dtype=np.int64)  # place of each cell within its block
    block_of = np.empty(len(mesh.shapes), dtype=np.int64)
    for block, cells in enumerate(members):
        places[cells], block_of[cells] = np.arange(len(cells)), block
    for name, of_vertices, listed in mesh._handle.sets:
        if of_vertices:
            made.point_sets[name] = np.array(listed)
        else:
            made.cell_sets[name] = [places[listed[block_of[listed] == block]] for block in range(len(members))]


def _type_name(shape: str, width: int) -> str:
    name = {"tetrahedron": "tetra"}.get(shape, shape)
    linear = {"vertex": 1, "line": 2, "triangle": 3, "quad": 4, "tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}
    return name if name == "polygon" or linear.get(name) == width else f"{name}{width}"


def host(mesh: Any) -> Host:
    """Returns the host of a meshio.Mesh."""
    if not hasattr(mesh, "cell_sets"):
        raise InvalidArgument(f"mesh: expected a meshio.Mesh, not meshio's {type(mesh).__name__}")
    return MeshioMesh(mesh)
