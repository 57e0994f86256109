# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Packages that some functions need and the rest does without."""

from __future__ import annotations

import importlib
from typing import Any


def load(module: str, extra: str) -> Any:
    """Imports a module that one of the package's extras brings.

    Raises:
        ImportError: it is not installed; the message names the extra.
    """
    package = module.partition(".")[0]
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != package:
            raise
        raise ImportError(
            f"{package} is needed and not installed; pip install 'meshorder[{extra}]' brings it", name=package
        ) from None
