# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Showing a mesh coloured by its orders, in a notebook or the browser."""

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
    """Returns the orders to show, by name; repeated names get a number: "rcm (2)"."""
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
    """Returns the name and the permutation of the vertices of an order, or of a method given by name."""
    if isinstance(order, str):
        order = reorder(mesh, vertices=order, elements="original")[1]
    if isinstance(order, MeshOrder):
        order = order.vertices
    name, permutation = (order.method, order.permutation) if isinstance(order, Order) else ("given", order)
    if not isinstance(permutation, Permutation):
        raise InvalidArgument(f"show: expected orders or names of methods, not {type(order).__name__}")
    if len(permutation) != len(mesh.points):
        raise InvalidArgument(f"show: an order of {len(permutation):,} vertices for a mesh of {len(mesh.points):,}")
    return name, permutation


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def show(mesh: Any, order: Any = None, *, path: str | os.PathLike[str] | None = None) -> Page:
    """Shows a mesh's surface coloured by the places of its vertices, in the present order and in others.

    Makes a page in HTML with a view of the mesh for each order, which can be turned and zoomed, and the sparsity
    patterns. In a notebook the page appears if the call is the last line of a cell; elsewhere it opens in the
    browser, as a temporary file.

    Args:
        mesh: the path of a file, or a mesh that `reorder` takes, with surfaces or volumes, before it is reordered.
        order: a `MeshOrder`, `Order` or `Permutation` of the mesh's vertices, or the name of a method; a list of
            these, or ``{name: order}``; None: "auto".
        path: a file for the page, which is then not opened.

    Returns:
        The page. Its attribute ``html`` is a text of 0.9 MB and about 15 bytes for each triangle of the surface;
        ``save(path)`` writes it. A notebook that shows the page stores it.

    Raises:
        InputError: the mesh has neither surfaces nor volumes, or the file cannot be read.
        InvalidArgument: an order of another size, an unknown method, an object that is not a mesh.
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
            warnings.warn(f"show: no browser was found; the page is in {file}", stacklevel=2)
    return page
