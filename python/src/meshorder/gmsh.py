# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders for the model that Gmsh holds, between ``gmsh.model.mesh.generate`` and ``gmsh.write``."""

from __future__ import annotations

from typing import Any

from . import _orders, _payoff
from ._meshes import MeshOrder
from ._payoff import Advice, Comparison

__all__ = ["advise", "compare", "reorder"]


def _model() -> Any:
    import gmsh

    return gmsh.model


def reorder(**options: Any) -> MeshOrder:
    """Orders the current model's mesh, all entities together, and gives nodes and elements their new tags.

    The tags are the same as before: the vertex that comes first gets the least. Elements stay in their entity, so
    physical groups and periodic entities hold; ``group_by="physical"`` or "entity" orders within these.

    Who takes nodes by their tags, from this model or a file in MSH 4, sees the new order. MSH files list nodes entity
    by entity, and MSH 2.2 numbers them anew: for readers that go by the place in the file, reorder the file.
    Views that name nodes or elements by tags are not changed.

    Args:
        **options: as of `meshorder.reorder`.

    Raises:
        InvalidArgument: Gmsh is not initialized or has no mesh.
        Unavailable: a Gmsh whose ``renumberNodes`` takes no tags.
    """
    return _orders.reorder(_model(), inplace=True, **options)[1]


def compare(methods: Any = None, **options: Any) -> Comparison:
    """As `meshorder.compare`, of the current model's mesh."""
    return _payoff.compare(_model(), methods, **options)


def advise(**options: Any) -> Advice:
    """As `meshorder.advise`, of the current model's mesh."""
    return _payoff.advise(_model(), **options)
