# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Reorders the mesh of Gmsh's current model, between ``gmsh.model.mesh.generate`` and ``gmsh.write``."""

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
    """Orders the current model's mesh, all entities together, and gives nodes and elements new tags.

    The set of tags stays the same: the first vertex of the new order gets the smallest tag. Elements stay in their
    entity, so that physical groups and periodic entities stay valid; ``group_by="physical"`` or "entity" orders within
    groups or entities.

    Programs that use the tags of nodes, from this model or from a file in MSH 4, see the new order. MSH files list
    nodes entity by entity, and MSH 2.2 numbers them again: for programs that use the places in the file, reorder the
    file with `meshorder.reorder`. Views that name nodes or elements by tags are not changed.

    Args:
        **options: ``vertices``, ``elements``, ``group_by`` and the options of `meshorder.reorder`.

    Returns:
        The orders. Their numbers count vertices from 0 by ascending old tags, and elements from 0 as Gmsh listed them,
        entity by entity.

    Raises:
        InvalidArgument: Gmsh is not initialized, its model has no mesh or elements of a type that cannot be ordered.
        Unavailable: the ``renumberNodes`` of this version of Gmsh takes no tags.
        ImportError: Gmsh is not installed.
    """
    return _orders.reorder(_model(), inplace=True, **options)[1]


def compare(methods: Any = None, **options: Any) -> Comparison:
    """Compares orders of the current model's mesh; see `meshorder.compare`."""
    return _payoff.compare(_model(), methods, **options)


def advise(**options: Any) -> Advice:
    """Says how much reordering the current model's mesh would gain; see `meshorder.advise`."""
    return _payoff.advise(_model(), **options)
