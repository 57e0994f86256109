# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The methods that order, those of users among them."""

from __future__ import annotations

import atexit
import os
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numpy as np

from . import _core
from ._arrays import integers

_Function = TypeVar("_Function", bound=Callable[..., Any])

# calls of other threads and methods in Python must be gone before the interpreter is
atexit.register(_core.end)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_core.forget_calls)


class MethodInfo(NamedTuple):
    """Description of a method.

    Attributes:
        name: to ask for it.
        description: one line.
        needs_points: whether it needs coordinates.
        deterministic: whether it gives the same order on every run.
        source: "built in", "Python" or a plug-in's name.
    """

    name: str
    description: str
    needs_points: bool
    deterministic: bool
    source: str


def methods(of: str = "vertices") -> list[MethodInfo]:
    """Lists the methods for "vertices" or "elements"."""
    listed = {"vertices": _core.vertex_methods, "elements": _core.element_methods}[of]()
    return [MethodInfo(*method) for method in listed]


def register(name: str, description: str = "", *, needs_points: bool = False) -> Callable[[_Function], _Function]:
    """Makes a function of Python's a method for vertices.

    The function gets ``(offsets, neighbours)`` and an array of points, which is empty where there are none, and
    returns ``new_to_old``::

        @meshorder.register("by-degree", "few neighbours first")
        def by_degree(graph, points):
            return np.argsort(np.diff(graph[0]), kind="stable")

        meshorder.order(matrix, "by-degree")
    """

    def decorate(function: _Function) -> _Function:
        def call(offsets: Any, neighbours: Any, points: Any) -> Any:
            return integers(function((offsets, neighbours), np.asarray(points).reshape(-1, 3)), "new_to_old")

        _core.register(name, description, needs_points, call)
        return function

    return decorate


def unregister(name: str) -> None:
    """Takes a method of Python's out of the list."""
    if not _core.unregister(name):
        raise KeyError(name)


def load_methods(path: Any) -> None:
    """Loads a shared library with methods (see meshorder.h). This runs its code."""
    _core.load_methods(str(path))
