# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Finds the host of another library's mesh by the module of its class, without importing the library."""

from __future__ import annotations

import importlib
from typing import Any

from .._errors import InvalidArgument
from .host import Host

#: for each library, the module of this package that handles its meshes
_MODULES = {
    "meshorder": "native",
    "meshio": "meshio",
    "pyvista": "vtk",
    "vtkmodules": "vtk",
    "skfem": "skfem",
    "trimesh": "trimesh",
    "gmsh": "gmsh",
    "torch": "torch",
    "torch_sparse": "torch",
    "torch_geometric": "pyg",
    "builtins": "arrays",
}


def find_host(mesh: Any) -> Host | None:
    """Returns the host of a mesh; None for objects of other libraries.

    Raises:
        InvalidArgument: an object of one of the libraries that is not a mesh, or a mesh that cannot be ordered.
    """
    kind = mesh if isinstance(mesh, type) else type(mesh)
    for base in kind.__mro__[:-1]:
        module = _MODULES.get(base.__module__.partition(".")[0])
        if module is not None:
            host: Host | None = importlib.import_module(f"{__name__}.{module}").host(mesh)
            return host
    return None


def host_of(mesh: Any) -> Host:
    """Returns the host of a mesh.

    Raises:
        InvalidArgument: as `find_host`, and for objects of other libraries.
    """
    found = find_host(mesh)
    if found is None:
        raise InvalidArgument(
            "mesh: expected (points, cells), a mesh of meshorder, meshio, PyVista, VTK, scikit-fem, trimesh or Gmsh, or a graph "
            f"of PyTorch, not {type(mesh).__name__}{_remedy(mesh)}"
        )
    return found


def _remedy(given: Any) -> str:
    """Returns a remedy for an object that is not a mesh, or an empty text."""
    if isinstance(given, str):
        return "; meshorder.read makes a mesh of a file, meshorder.write(mesh, path) writes one"
    return "; meshorder.order(matrix).permutation.move(matrix) orders a matrix" if hasattr(given, "tocsr") else ""
