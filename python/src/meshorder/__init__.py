# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Reorders simulation meshes and sparse matrices so that physics on them runs faster.

A matrix or graph, and data of its rows::

    import meshorder

    order = meshorder.order(matrix)                      # a SciPy matrix, (indptr, indices) or a networkx graph
    faster, b = order.permutation.move(matrix), order.permutation.move(b)

A mesh with its data and sets; `advise` says how much a new order gains, before the mesh is changed::

    mesh = meshorder.read("dragon.msh")                  # or a mesh of meshio, PyVista, VTK, scikit-fem, trimesh, Gmsh
    print(meshorder.advise(mesh))
    mesh, order = meshorder.reorder(mesh)
"""

import importlib
from typing import TYPE_CHECKING, Any

from . import _interpreter  # noqa: F401  # must come before all that load the extension module
from ._core import build_info
from ._core import version as __version__
from ._errors import Error, InputError, InternalError, InvalidArgument, Stopped, TooLarge, Unavailable
from ._changing import Reorderer, Update
from ._files import make_mesh, read, to_bytes, write
from ._graphs import Fiedler, FiedlerComponent, Order, Quality, fiedler, quality
from ._layouts import (
    Colours,
    GatherLists,
    GpuCost,
    Patches,
    colours,
    gather_lists,
    gpu_cost,
    gpu_product_cost,
    patches,
    sort_corners,
)
from ._meshes import Mesh, MeshOrder
from ._methods import MethodInfo, load_methods, methods, register, unregister
from ._options import Options
from ._orders import order, order_edges, order_mesh, reorder
from ._payoff import Advice, Calibration, Candidate, Comparison, advise, calibrate, compare
from ._permutation import Permutation
from ._show import show
from ._try import Trial, TriedOrder, try_orders

if TYPE_CHECKING:
    from ._gpu import GpuComparison, GpuOrder, GpuTime, compare_on_gpu

__all__ = [
    "Advice", "Calibration", "Candidate", "Colours", "Comparison", "Error", "Fiedler", "FiedlerComponent", "GatherLists",
    "GpuComparison", "GpuCost", "GpuOrder", "GpuTime", "InputError", "InternalError", "InvalidArgument", "Mesh",
    "MeshOrder", "MethodInfo", "Options", "Order", "Patches", "Permutation", "Quality", "Reorderer", "Stopped", "TooLarge",
    "Trial", "TriedOrder", "Unavailable", "Update", "__version__", "advise", "build_info", "calibrate", "colours",
    "compare", "compare_on_gpu", "fiedler", "gather_lists", "gpu_cost", "gpu_product_cost", "load_methods", "make_mesh",
    "methods", "order", "order_edges", "order_mesh", "patches", "quality", "read", "register", "reorder", "show",
    "sort_corners", "to_bytes", "try_orders", "unregister", "write",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    """Imports the modules for other libraries and for GPUs when they are first used."""
    if name in ("csgraph", "gmsh", "mpi", "networkx", "pyvista"):
        return importlib.import_module(f"{__name__}.{name}")
    if name in ("GpuComparison", "GpuOrder", "GpuTime", "compare_on_gpu"):
        return getattr(importlib.import_module(f"{__name__}._gpu"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
