# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The meshes of scikit-fem."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._errors import InvalidArgument
from .._meshes import MeshOrder
from .._permutation import Permutation
from .host import Host

#: by dimension and number of corners: the shape, and the rows of ``mesh.t`` in VTK's order of corners
_SHAPES = {
    (1, 2): ("line", [0, 1]),
    (2, 3): ("triangle", [0, 1, 2]),
    (2, 4): ("quad", [0, 1, 2, 3]),
    (3, 4): ("tetrahedron", [0, 1, 2, 3]),
    (3, 6): ("wedge", [0, 1, 2, 3, 4, 5]),
    (3, 8): ("hexahedron", [0, 3, 6, 2, 1, 5, 7, 4]),
}


class SkfemMesh(Host):
    """A skfem.Mesh. In quadratic meshes only the corners are ordered; scikit-fem numbers the nodes between them."""

    def __init__(self, mesh: Any) -> None:
        if any(base.__name__ == "MeshDG" for base in type(mesh).__mro__):
            raise InvalidArgument("mesh: scikit-fem's discontinuous meshes cannot be reordered")
        refdom = mesh.elem.refdom
        shape = _SHAPES.get((refdom.dim(), mesh.t.shape[0]))
        if shape is None:
            raise InvalidArgument(f"mesh: scikit-fem's meshes of the type {type(mesh).__name__} cannot be ordered")
        self.given = mesh
        self._is_quadratic = len(mesh.elem.doflocs) > mesh.t.shape[0]
        self._corners = int(mesh.t.max(initial=-1)) + 1 if self._is_quadratic else mesh.p.shape[1]
        self.points = mesh.p[:, : self._corners].T
        self.cells = [(shape[0], mesh.t[shape[1]].T)]

    def cell_sets(self) -> Mapping[str, Any]:
        return self.given.subdomains or {}

    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        if inplace:
            raise InvalidArgument("inplace: scikit-fem's meshes cannot be changed; use the one that reorder returns")
        mesh = self.given
        vertices, cells = order.vertices.permutation, order.cells.permutation
        t = vertices.renumber(mesh.t)[:, cells.new_to_old]
        doflocs = vertices.move(self.points).T
        if self._is_quadratic:
            # scikit-fem expects the nodes between corners as further rows of t, and renumbers them
            between = mesh.dofs.element_dofs[mesh.t.shape[0] :, cells.new_to_old]
            t = np.vstack([t, between])
            doflocs = np.hstack([doflocs, mesh.doflocs[:, self._corners :]])
        moved = dataclasses.replace(
            mesh, doflocs=np.ascontiguousarray(doflocs), t=np.ascontiguousarray(t), _boundaries=None, _subdomains=None
        )
        if mesh.subdomains is not None:
            moved._subdomains = {
                name: cells.old_to_new[members].astype(members.dtype) for name, members in mesh.subdomains.items()
            }
        if mesh.boundaries is not None:
            moved._boundaries = _moved_boundaries(mesh, moved, vertices, cells)
        return moved


def _moved_boundaries(mesh: Any, moved: Any, vertices: Permutation, cells: Permutation) -> dict[str, Any]:
    """Returns the boundaries with new numbers of their facets; the element on the side of each stays the same."""
    new_facet = _new_facets(vertices.renumber(mesh.facets), moved.facets)
    boundaries = {}
    for name, facets in mesh.boundaries.items():
        numbers = new_facet[facets].astype(facets.dtype)
        side = getattr(facets, "ori", None)
        if side is not None:
            element = mesh.f2t[side, np.asarray(facets)]
            new_element = np.where(element < 0, -1, cells.old_to_new[element])
            numbers = type(facets)(numbers, (moved.f2t[0, numbers] != new_element).astype(np.int64))
        boundaries[name] = numbers
    return boundaries


def _new_facets(facets: NDArray[Any], new_facets: NDArray[Any]) -> NDArray[Any]:
    """Returns the new number of each facet, given as a column of new vertex numbers."""
    old, new = (np.lexsort(np.sort(columns, axis=0)) for columns in (facets, new_facets))
    places = np.empty(facets.shape[1], dtype=np.int64)
    places[old] = new
    return places


def host(mesh: Any) -> Host:
    """Returns the host of a skfem.Mesh."""
    if isinstance(mesh, type) or not hasattr(mesh, "doflocs") or not hasattr(mesh, "t"):
        name = mesh.__name__ if isinstance(mesh, type) else type(mesh).__name__
        raise InvalidArgument(f"mesh: expected a mesh of scikit-fem, not its {name}")
    return SkfemMesh(mesh)
