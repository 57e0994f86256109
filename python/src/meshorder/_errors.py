# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""What meshorder raises. Each class is also the one of Python's own that fits, so `except ValueError` works."""

from __future__ import annotations

__all__ = ["Error", "InputError", "InternalError", "InvalidArgument", "Stopped", "TooLarge", "Unavailable"]


class Error(Exception):
    """Base class of all that meshorder raises."""


class InvalidArgument(Error, ValueError):
    """An unknown method, a map that is no permutation, sizes that do not match, an asymmetric graph, NaN."""


class InputError(Error, ValueError):
    """A faulty file.

    Attributes:
        file: its name.
        line: line of the fault, from 1; None for binary files.
        byte: place of the fault, from 0; None for text.
    """

    file: str | None = None
    line: int | None = None
    byte: int | None = None


class TooLarge(Error, OverflowError):
    """2³¹ or more vertices or cells."""


class Unavailable(Error, RuntimeError):
    """A method or a compression that this build lacks."""


class Stopped(Error, RuntimeError):
    """The progress function returned False."""


class InternalError(Error, RuntimeError):
    """A failure inside meshorder or a library that it uses."""


for _name in __all__:
    globals()[_name].__module__ = "meshorder"
