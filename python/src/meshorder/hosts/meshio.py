# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""meshio's meshes."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import integers
from .._errors import InvalidArgument
from .._meshes import Mesh, MeshOrder
from .._permutation import Permutation
from .host import Host, parts


class MeshioMesh(Host):
    """A meshio.Mesh. Cells stay within their block, so blocks keep their sizes."""

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
        return {
            name: np.concatenate(
                [
                    integers(members, f"set '{name}'").astype(np.int64) + start
                    for members, start in zip(blocks, self._starts)
                    if members is not None
                ]
                or [np.zeros(0, dtype=np.int64)]
            )
            for name, blocks in self.given.cell_sets.items()
        }

    def mesh(self) -> Mesh:
        made = super().mesh()
        made.notes += [f"field data '{name}' was left out: a meshorder.Mesh has none" for name in self.given.field_data]
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
            "point_data": {name: by_vertex.move(np.asanyarray(values)) for name, values in mesh.point_data.items()},
            "point_sets": {name: _renumbered(by_vertex.old_to_new, s, name) for name, s in mesh.point_sets.items()},
            "cells": [_moved_block(block, by_vertex, part) for block, part in zip(mesh.cells, by_cell)],
            "cell_data": {
                name: [part.move(np.asanyarray(values)) for values, part in zip(blocks, by_cell)]
                for name, blocks in mesh.cell_data.items()
            },
            "cell_sets": {
                name: [
                    None if members is None else _renumbered(part.old_to_new, members, name)
                    for members, part in zip(blocks, by_cell)
                ]
                for name, blocks in mesh.cell_sets.items()
            },
            "gmsh_periodic": self._periodic(by_vertex.old_to_new),
        }
        moved = mesh if inplace else copy.copy(mesh)
        for name, value in new.items():
            setattr(moved, name, value)
        if not inplace:
            moved.field_data = dict(mesh.field_data)
        return moved

    def _periodic(self, old_to_new: NDArray[Any]) -> Any:
        """Gmsh's pairs of periodic points: [dimension, entities, transformation, pairs] for each entity."""
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
    """The values of all blocks, masked where one is."""
    library: Any = np.ma if any(map(np.ma.is_masked, blocks)) else np
    return library.concatenate(blocks)


def _renumbered(new_places: NDArray[Any], members: Any, name: str) -> NDArray[Any]:
    """The new numbers of the members of a set, in their type."""
    numbers = integers(members, f"set '{name}'", rank=None)
    if numbers.size and (numbers.min() < 0 or numbers.max() >= len(new_places)):
        raise InvalidArgument(f"set '{name}' names what is outside 0 … {len(new_places) - 1}")
    renumbered: NDArray[Any] = new_places[numbers].astype(numbers.dtype)
    return renumbered


def host(mesh: Any) -> Host:
    """The host of a meshio.Mesh."""
    if not hasattr(mesh, "cell_sets"):
        raise InvalidArgument(f"mesh: expected a meshio.Mesh, not meshio's {type(mesh).__name__}")
    return MeshioMesh(mesh)
