# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""meshorder's own meshes."""

from __future__ import annotations

from typing import Any, NoReturn

from .._errors import InvalidArgument
from .._meshes import Mesh, MeshOrder
from .._options import prepared
from .host import Host, Request


class NativeMesh(Host):
    """A `meshorder.Mesh`."""

    def __init__(self, mesh: Mesh) -> None:
        self.given = mesh
        self.points = mesh.points
        self.cells = mesh.cells

    def reorder(self, request: Request) -> tuple[Any, MeshOrder]:
        moved = self.given.copy()
        with prepared(request.options) as given:
            made = moved._handle.reorder(
                request.vertices, request.elements, request.ids, request.group_by or "", request.format or "", given
            )
        if request.inplace:
            # arrays that were taken from the mesh remain views of the old handle
            self.given._handle = moved._handle
            moved = self.given
        return moved, MeshOrder._of(made)

    def moved(self, order: MeshOrder, inplace: bool) -> NoReturn:
        raise NotImplementedError("the library orders and moves a Mesh in one step")

    def mesh(self) -> Mesh:
        mesh: Mesh = self.given
        return mesh


def host(mesh: Any) -> Host:
    """Returns the host of a `meshorder.Mesh`."""
    if not isinstance(mesh, Mesh):
        raise InvalidArgument(f"mesh: expected a meshorder.Mesh, not {type(mesh).__name__}")
    return NativeMesh(mesh)
