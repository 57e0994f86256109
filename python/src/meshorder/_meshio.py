# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Reordering a meshio.Mesh."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from ._graphs import Order
from ._meshes import MeshOrder, order_mesh


def reorder(
    mesh: Any, vertices: str, elements: str, inplace: bool, options: dict[str, Any]
) -> tuple[Any, MeshOrder]:
    """See `meshorder.reorder`. Cells stay within their block, so blocks keep their sizes."""
    order = order_mesh(mesh.points, mesh.cells, vertices=vertices, elements=elements, **options)
    moved = mesh if inplace else copy.copy(mesh)
    by_vertex = order.vertices.permutation
    moved.points = by_vertex.move(mesh.points)
    moved.point_data = {name: by_vertex.move(np.asarray(values)) for name, values in mesh.point_data.items()}
    moved.point_sets = {name: by_vertex.old_to_new[members] for name, members in mesh.point_sets.items()}

    places = _places_within_blocks(mesh, order.cells)
    moved.cells = [
        type(block)(block.type, by_vertex.renumber(np.asarray(block.data)[place]))
        for block, place in zip(mesh.cells, places)
    ]
    moved.cell_data = {
        name: [np.asarray(values)[place] for values, place in zip(blocks, places)]
        for name, blocks in mesh.cell_data.items()
    }
    inverses = [np.argsort(place) for place in places]
    moved.cell_sets = {
        name: [
            members if members is None else inverse[members].astype(np.asarray(members).dtype)
            for members, inverse in zip(blocks, inverses)
        ]
        for name, blocks in mesh.cell_sets.items()
    }
    return moved, order


def _places_within_blocks(mesh: Any, cells: Order) -> list[Any]:
    """For each block the old place of each new cell, within the block."""
    starts = np.cumsum([0, *(len(block.data) for block in mesh.cells)])
    return [cells.new_to_old[begin:end] - begin for begin, end in zip(starts[:-1], starts[1:])]
