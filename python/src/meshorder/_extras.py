# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Imports optional packages, which only some functions need."""

from __future__ import annotations

import importlib
from typing import Any


def load(module: str, extra: str) -> Any:
    """Imports and returns a module of an optional package.

    Raises:
        ImportError: the package is not installed; the message names the extra of meshorder that installs it.
    """
    package = module.partition(".")[0]
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != package:
            raise
        raise ImportError(
            f"{package} is needed and not installed; pip install 'meshorder[{extra}]' installs it", name=package
        ) from None
