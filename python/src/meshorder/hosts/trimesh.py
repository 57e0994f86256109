# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The surfaces of trimesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .._errors import InvalidArgument
from .._meshes import MeshOrder
from .host import Host


class TrimeshSurface(Host):
    """A trimesh.Trimesh. Its own methods move its attributes, colours and texture coordinates."""

    def __init__(self, mesh: Any) -> None:
        self.given = mesh
        self.points = np.asarray(mesh.vertices).reshape(-1, 3)
        self.cells = [("triangle", np.asarray(mesh.faces).reshape(-1, 3))]

    def point_data(self) -> Mapping[str, Any]:
        return _with_rows(self.given.vertex_attributes, len(self.points))

    def cell_data(self) -> Mapping[str, Any]:
        return _with_rows(self.given.face_attributes, len(self.cells[0][1]))

    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        for name, values in (*self.point_data().items(), *self.cell_data().items()):
            if isinstance(values, (list, tuple)):
                raise InvalidArgument(f"mesh: attribute '{name}' must be an array, not a list, to be moved")
        # the cache alone holds normals that the caller set; a change of faces clears it
        normals = [self.given._cache[name] for name in ("face_normals", "vertex_normals")]
        mesh = self.given if inplace else self.given.copy()
        if not inplace:  # versions before 4.5 copy no attributes
            mesh.vertex_attributes = {**self.given.vertex_attributes, **mesh.vertex_attributes}
            mesh.face_attributes = {**self.given.face_attributes, **mesh.face_attributes}
        by_face, by_vertex = order.cells.new_to_old, order.vertices.new_to_old
        face_materials = getattr(mesh.visual, "face_materials", None)
        if face_materials is not None and len(face_materials) == len(by_face):
            mesh.visual.face_materials = np.asarray(face_materials)[by_face]
        mesh.update_faces(np.array(by_face, dtype=np.int64))
        mesh.update_vertices(
            np.array(by_vertex, dtype=np.int64), inverse=np.array(order.vertices.old_to_new, dtype=np.int64)
        )
        if normals[0] is not None and len(normals[0]) == len(by_face):
            mesh.face_normals = normals[0][by_face]
        if normals[1] is not None and len(normals[1]) == len(by_vertex):
            mesh.vertex_normals = normals[1][by_vertex]
        return mesh


def _with_rows(attributes: Mapping[str, Any], count: int) -> dict[str, Any]:
    return {name: values for name, values in attributes.items() if _length(values) == count}


def _length(values: Any) -> int:
    try:
        return len(values)
    except TypeError:  # values without a length
        return -1


def host(mesh: Any) -> Host:
    """Returns the host of a trimesh.Trimesh."""
    if isinstance(mesh, type) or not hasattr(mesh, "face_attributes"):
        name = mesh.__name__ if isinstance(mesh, type) else type(mesh).__name__
        raise InvalidArgument(f"mesh: expected a trimesh.Trimesh, not trimesh's {name}")
    return TrimeshSurface(mesh)
