# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Showing a mesh in its orders, in a notebook or the browser."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._errors import InvalidArgument
from ._files import mesh_of
from ._graphs import Order
from ._meshes import Mesh, MeshOrder
from ._orders import reorder
from ._permutation import Permutation

if TYPE_CHECKING:
    from ._page import Page


def _named(order: Any, mesh: Mesh) -> dict[str, Permutation]:
    """The orders to show, each with its name."""
    if isinstance(order, Mapping):
        return {str(name): _permutation(one, mesh)[1] for name, one in order.items()}
    given = order if isinstance(order, (list, tuple)) else ["auto" if order is None else order]
    named: dict[str, Permutation] = {}
    for one in given:
        name, permutation = _permutation(one, mesh)
        repeats = sum(known.partition(" (")[0] == name for known in named)
        named[f"{name} ({repeats + 1})" if repeats else name] = permutation
    return named


def _permutation(order: Any, mesh: Mesh) -> tuple[str, Permutation]:
    if isinstance(order, str):
        order = reorder(mesh, vertices=order, elements="original")[1]
    if isinstance(order, MeshOrder):
        order = order.vertices
    name, permutation = (order.method, order.permutation) if isinstance(order, Order) else ("given", order)
    if not isinstance(permutation, Permutation):
        raise InvalidArgument(f"show: expected orders or names of methods, not {type(order).__name__}")
    if len(permutation) != len(mesh.points):
        raise InvalidArgument(f"show: an order of {len(permutation):,} for a mesh of {len(mesh.points):,} vertices")
    return name, permutation


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def show(mesh: Any, order: Any = None, *, path: str | os.PathLike[str] | None = None) -> Page:
    """Shows a mesh's surface coloured by the places of its vertices, before and after, and both sparsity patterns.

    In a notebook the page appears where the call is the last line of a cell; elsewhere it opens in the browser, as a
    temporary file. It can be turned and zoomed.

    Args:
        mesh: as of `advise`, with surfaces or volumes; in the order that it had before.
        order: a `MeshOrder`, `Order` or `Permutation` of its vertices, the name of a method, several of these in a
            list, or ``{name: order}``; None: "auto".
        path: writes the page there and opens nothing.

    Returns:
        The page: 0.9 MB, and about 15 bytes for each triangle of the surface. A notebook that shows it stores it.

    Raises:
        InputError: the mesh has neither surfaces nor volumes.
        InvalidArgument: an order of another size, an unknown method.
        Unavailable: this build lacks three.js.
    """
    from ._page import make_page  # takes time to import

    name = os.path.basename(mesh) if isinstance(mesh, (str, os.PathLike)) else ""
    whole = mesh_of(mesh)
    page = make_page(whole, _named(order, whole), name)
    if path is not None:
        page.save(path)
    elif not _in_notebook():
        import pathlib
        import tempfile
        import webbrowser

        handle, file = tempfile.mkstemp(prefix="meshorder-", suffix=".html")
        os.close(handle)
        page.save(file)
        if not webbrowser.open(pathlib.Path(file).as_uri()):
            warnings.warn(f"show: found no browser; the page is {file}", stacklevel=2)
    return page
