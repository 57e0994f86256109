# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Makes the Python reference: everything that `meshorder.__all__` names, by subject, and the public modules."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from types import ModuleType
from typing import Any

import meshorder

INTRODUCTION = """Python reference
================

Everything here is in the package ``meshorder``; its guide is :doc:`/python`.

"""


#: sections in their order; those of other modules stand before the errors, under the first sentence of the module
SECTIONS = {
    "_orders": "Orders",
    "_graphs": "Graphs and matrices",
    "_permutation": "Permutations",
    "_options": "Options",
    "_meshes": "Meshes",
    "_files": "Meshes from arrays and files",
    "_payoff": "What orders are worth",
    "_try": "What orders are worth to a function of yours",
    "_methods": "Methods",
    "_errors": "Errors",
    "_core": "Version",
}


def place_of(module: ModuleType) -> float:
    """Where the section of a module stands."""
    names = list(SECTIONS)
    name = module.__name__.rpartition(".")[2]
    return names.index(name) if name in names else names.index("_errors") - 0.5


def title_of(module: ModuleType) -> str:
    name = module.__name__.rpartition(".")[2]
    return SECTIONS.get(name) or (inspect.getdoc(module) or name).split("\n")[0].rstrip(".").replace("`", "")


def heading(title: str, underline: str) -> list[str]:
    return ["", title, underline * len(title), ""]


def directive(name: str, value: Any) -> list[str]:
    kind = "function"
    if inspect.isclass(value):
        kind = "exception" if issubclass(value, BaseException) else "class"
    elif not callable(value):
        kind = "data"
    bases = ["   :show-inheritance:"] if kind == "exception" else []
    return [f".. auto{kind}:: meshorder.{name}", *bases, ""]


def module_of(value: Any) -> str:
    """The module that something public comes from; classes of errors say that it is the package."""
    if inspect.isclass(value) and issubclass(value, BaseException):
        return "meshorder._errors"
    module = getattr(value, "__module__", None) or ""
    return module if module.startswith("meshorder.") else "meshorder._core"


def package_page() -> str:
    """The page of the package itself, a section for each of its modules."""
    by_module: dict[ModuleType, list[str]] = {}
    for name in meshorder.__all__:
        module = importlib.import_module(module_of(getattr(meshorder, name)))
        by_module.setdefault(module, []).append(name)
    lines = [INTRODUCTION]
    for module, names in sorted(by_module.items(), key=lambda item: place_of(item[0])):
        lines += heading(title_of(module), "-")
        # functions before what they take and return
        for name in sorted(names, key=lambda name: (inspect.isclass(getattr(meshorder, name)), name)):
            if not name.startswith("__"):
                lines += directive(name, getattr(meshorder, name))
    for path in public_modules():
        lines += heading(f"``{path}``", "-")
        lines += [f".. automodule:: {path}", "   :members:", ""]
    return "\n".join(lines)


def public_modules() -> list[str]:
    """The modules that users import by themselves, those with `__all__`: "meshorder.csgraph"."""
    modules = [
        f"meshorder.{one.name}" for one in pkgutil.iter_modules(meshorder.__path__) if not one.name.startswith("_")
    ]
    return [module for module in modules if hasattr(importlib.import_module(module), "__all__")]
