# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The accessor ``grid.meshorder`` of PyVista's UnstructuredGrid and PolyData.

PyVista 0.48 and later import this module when the accessor is first used; no other import is needed.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import pyvista

from . import _orders, _payoff
from ._payoff import Advice, Comparison

__all__ = ["MeshorderAccessor"]

if not hasattr(pyvista, "register_dataset_accessor"):
    raise ImportError(f"grid.meshorder needs PyVista 0.48 or later, not {pyvista.__version__}")


@pyvista.register_dataset_accessor("meshorder", pyvista.UnstructuredGrid)
@pyvista.register_dataset_accessor("meshorder", pyvista.PolyData)
class MeshorderAccessor:
    """Orders a PyVista dataset: ``grid.meshorder.reorder("hilbert").plot()``."""

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def reorder(self, vertices: str = "auto", *, inplace: bool = False, **options: Any) -> Any:
        """Returns the dataset in a new order, with the arrays ``original_point`` and ``original_cell``.

        They hold, for each point and cell, its number in this dataset; earlier arrays of these names are replaced.

        Args:
            vertices: method for the vertices: "auto" or the name of one of `meshorder.methods`.
            inplace: True changes this dataset and returns it.
            **options: ``elements``, ``group_by`` and the options of `meshorder.reorder`.

        Raises:
            InvalidArgument, Unavailable, Stopped: as `meshorder.reorder`.
        """
        moved, order = _orders.reorder(self._dataset, vertices=vertices, inplace=inplace, **options)
        moved.point_data["original_point"] = np.array(order.vertices.new_to_old, dtype=np.int64)
        moved.cell_data["original_cell"] = np.array(order.cells.new_to_old, dtype=np.int64)
        return moved

    def compare(self, methods: Any = None, **options: Any) -> Comparison:
        """Compares orders of the dataset; see `meshorder.compare`."""
        return _payoff.compare(self._dataset, methods, **options)

    def advise(self, **options: Any) -> Advice:
        """Says how much reordering the dataset would gain; see `meshorder.advise`."""
        return _payoff.advise(self._dataset, **options)
