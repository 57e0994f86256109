# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The current model of Gmsh."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._errors import InvalidArgument, Unavailable
from .._meshes import MeshOrder
from .host import Host, parts

#: shapes by the first word of Gmsh's names of element types, such as "Tetrahedron 10"
_SHAPES = {
    "Point": "vertex",
    "Line": "line",
    "Triangle": "triangle",
    "Quadrilateral": "quad",
    "Tetrahedron": "tetrahedron",
    "Hexahedron": "hexahedron",
    "Prism": "wedge",
    "Pyramid": "pyramid",
}


class _Block(NamedTuple):
    """The elements of one type in an entity."""

    dimension: int
    entity: int
    type: int
    tags: NDArray[Any]


class GmshModel(Host):
    """The current model of the module gmsh.

    Vertices are numbered from 0 by ascending tags, elements as Gmsh lists them: entity by entity, type by type.
    Elements stay in their entity. Nodes keep the same set of tags, in the new order; so do the elements of a type in an
    entity.
    """

    def __init__(self, model: Any) -> None:
        import gmsh

        if not gmsh.isInitialized():
            raise InvalidArgument("gmsh: Gmsh is not initialized; call gmsh.initialize() and generate a mesh first")
        self.given = model
        self._mesh = gmsh.model.mesh
        tags, coordinates, _ = self._mesh.getNodes()
        if len(tags) == 0:
            raise InvalidArgument("gmsh: the current model has no mesh; generate one first")
        by_tag = np.argsort(tags)
        self._tags = tags[by_tag]
        self.points = coordinates.reshape(-1, 3)[by_tag]
        self._blocks: list[_Block] = []
        self.cells = []
        for dimension, entity in gmsh.model.getEntities():
            for kind, elements, nodes in zip(*self._mesh.getElements(dimension, entity)):
                self._blocks.append(_Block(dimension, entity, int(kind), elements))
                self.cells.append((self._shape(kind), self._vertices(nodes).reshape(len(elements), -1)))

    def _shape(self, kind: int) -> str:
        name = self._mesh.getElementProperties(kind)[0]
        shape = _SHAPES.get(name.partition(" ")[0])
        if shape is None:
            raise InvalidArgument(f"gmsh: elements of type {name!r} cannot be ordered")
        return shape

    def _vertices(self, tags: NDArray[Any]) -> NDArray[np.int32]:
        places = np.searchsorted(self._tags, tags)
        return places.astype(np.int32)

    def cell_data(self) -> Mapping[str, Any]:
        """Returns the entity and the first physical group (0: none) of each element, as "entity" and "physical"."""
        import gmsh

        groups = {}
        for block in self._blocks:
            found = gmsh.model.getPhysicalGroupsForEntity(block.dimension, block.entity)
            groups[block[:2]] = int(found[0]) if len(found) else 0
        sizes = [len(block.tags) for block in self._blocks]
        return {
            "entity": np.repeat(np.array([block.entity for block in self._blocks], dtype=np.int64), sizes),
            "physical": np.repeat(np.array([groups[block[:2]] for block in self._blocks], dtype=np.int64), sizes),
        }

    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        if not inplace:
            raise InvalidArgument("inplace: Gmsh has one running model, which can only be changed; pass inplace=True")
        if "oldTags" not in inspect.signature(self._mesh.renumberNodes).parameters:
            raise Unavailable("gmsh: renumberNodes of this version of Gmsh takes no tags; Gmsh 4.13 does")
        self._mesh.renumberNodes(self._tags, self._tags[order.vertices.old_to_new])
        old_tags, new_tags = [], []
        sizes = [len(block.tags) for block in self._blocks]
        for block, part in zip(self._blocks, parts(order.cells.permutation, sizes)):
            self._mesh.reorderElements(block.type, block.entity, part.new_to_old)
            old_tags.append(block.tags[part.new_to_old])
            new_tags.append(np.sort(block.tags))
        if old_tags:
            self._mesh.renumberElements(np.concatenate(old_tags), np.concatenate(new_tags))
        return self.given


def host(mesh: Any) -> Host:
    """Returns the host of ``gmsh.model``."""
    if not isinstance(mesh, type) or mesh.__name__ != "model":
        raise InvalidArgument("mesh: expected gmsh.model, not another object of the module gmsh")
    return GmshModel(mesh)
