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


#: the modules that most readers look for come first
FIRST = ("_graphs", "_permutation", "_options", "_meshes", "_payoff", "_methods")
LAST = ("_errors", "_core")


def place_of(module: str) -> tuple[int, str]:
    """Where the section of a module stands."""
    name = module.rpartition(".")[2]
    return (
        FIRST.index(name) if name in FIRST else len(FIRST) + LAST.index(name) + 1 if name in LAST else len(FIRST),
        name,
    )


def title_of(module: ModuleType) -> str:
    """The first words of a module's docstring: "Orders, Fiedler vectors and the quality of orders"."""
    return (inspect.getdoc(module) or module.__name__).split("\n")[0].rstrip(".")


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
    by_module: dict[str, list[str]] = {}
    for name in meshorder.__all__:
        value = getattr(meshorder, name)
        by_module.setdefault(module_of(value), []).append(name)
    lines = [INTRODUCTION]
    for module_name, names in sorted(by_module.items(), key=lambda item: place_of(item[0])):
        module = importlib.import_module(module_name)
        lines += heading("The version" if module_name.endswith("._core") else title_of(module), "-")
        # functions before what they take and return
        for name in sorted(names, key=lambda name: (inspect.isclass(getattr(meshorder, name)), name)):
            if not name.startswith("__"):
                lines += directive(name, getattr(meshorder, name))
    for module in public_modules():
        lines += heading(f"``{module}``", "-")
        lines += [f".. automodule:: {module}", "   :members:", ""]
    return "\n".join(lines)


def public_modules() -> list[str]:
    """The modules that users import by themselves, those with `__all__`: "meshorder.csgraph"."""
    modules = [
        f"meshorder.{one.name}" for one in pkgutil.iter_modules(meshorder.__path__) if not one.name.startswith("_")
    ]
    return [module for module in modules if hasattr(importlib.import_module(module), "__all__")]
