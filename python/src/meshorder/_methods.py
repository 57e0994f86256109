# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Lists ordering methods, and adds methods written in Python."""

from __future__ import annotations

import atexit
import os
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numpy as np

from . import _core
from ._arrays import integers
from ._errors import InvalidArgument

_Function = TypeVar("_Function", bound=Callable[..., Any])

# before the interpreter ends, calls in other threads must end, and Python functions must be released
atexit.register(_core.end)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_core.forget_calls)


class MethodInfo(NamedTuple):
    """Description of a method.

    Attributes:
        name: the value for ``method``, ``vertices`` or ``elements``.
        description: what the method does, in one line.
        needs_points: whether it needs coordinates.
        deterministic: whether it gives the same order on every run and for any number of threads.
        source: "built in", "Python" or a plug-in's name.
    """

    name: str
    description: str
    needs_points: bool
    deterministic: bool
    source: str


def methods(of: str = "vertices") -> list[MethodInfo]:
    """Lists the methods of this build and the registered ones.

    Args:
        of: "vertices" or "elements".

    Raises:
        InvalidArgument: ``of`` is neither.

    Example:
        >>> "rcm" in [method.name for method in meshorder.methods()]
        True
    """
    lists = {"vertices": _core.vertex_methods, "elements": _core.element_methods}
    if of not in lists:
        raise InvalidArgument(f"of: expected 'vertices' or 'elements', not {of!r}")
    return [MethodInfo(*method) for method in lists[of]()]


def register(name: str, description: str = "", *, needs_points: bool = False) -> Callable[[_Function], _Function]:
    """Makes a Python function a vertex method. All functions then know it by its name; "auto" never chooses it.

    The function is called as ``function((offsets, neighbours), points)`` with copies of a clean graph (rows ascending,
    symmetric, no loops, no repeats): n + 1 offsets (int64), the neighbours (int32), and n × 3 coordinates (float64), or
    0 × 3 if there are none. It returns ``new_to_old``, n integers. Its exceptions pass through.

    Args:
        name: lower-case letters, digits, "-" and "_"; not yet in the list.
        description: one line for lists of methods.
        needs_points: True: ordering without coordinates is an InvalidArgument.

    Returns:
        A decorator that registers the function and returns it.

    Raises:
        InvalidArgument: when the function is decorated: the name is taken or has other characters, or the object
            cannot be called.

    Example:
        A method that puts the vertices with the fewest neighbours first::

            @meshorder.register("by-degree", "few neighbours first")
            def by_degree(graph, points):
                return np.argsort(np.diff(graph[0]), kind="stable")

            meshorder.order(matrix, "by-degree")
    """

    def decorate(function: _Function) -> _Function:
        if not callable(function):
            raise InvalidArgument(f"register: expected a function, not {function!r}")

        def call(offsets: Any, neighbours: Any, points: Any) -> Any:
            return integers(function((offsets, neighbours), np.asarray(points).reshape(-1, 3)), "new_to_old")

        _core.register(name, description, needs_points, call)
        return function

    return decorate


def unregister(name: str) -> None:
    """Removes a method that was registered with `register` from the list.

    Raises:
        KeyError: no Python function is registered under that name.
    """
    if not _core.unregister(name):
        raise KeyError(name)


def load_methods(path: Any) -> None:
    """Loads a shared library that registers methods. Runs its code; the library is never unloaded.

    Args:
        path: a library with the function ``meshorder_plugin_v1`` (see meshorder.h).

    Raises:
        Unavailable: the library cannot be loaded, or lacks that function.
        InvalidArgument: the function reports a failure, such as a name that is taken.
    """
    _core.load_methods(str(path))
