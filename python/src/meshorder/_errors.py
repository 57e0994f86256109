# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The exceptions of meshorder. All but the base class also derive from the most fitting built-in exception."""

from __future__ import annotations

__all__ = ["Error", "InputError", "InternalError", "InvalidArgument", "Stopped", "TooLarge", "Unavailable"]


class Error(Exception):
    """Base class of meshorder's exceptions; raised itself if something cannot be stored or printed."""


class InvalidArgument(Error, ValueError):
    """An argument is wrong: an unknown method, a map that is not a permutation, sizes that do not match, NaN."""


class InputError(Error, ValueError):
    """A file or bytes cannot be read or written as a mesh.

    Attributes:
        file: name of the file; None if it is not known.
        line: line of the fault in a text, from 1; None if it is not known.
        byte: offset of the fault in binary data, from 0; None if it is not known.
    """

    file: str | None = None
    line: int | None = None
    byte: int | None = None


class TooLarge(Error, OverflowError):
    """Numbers do not fit: 2³¹ or more vertices, cells or degrees of freedom, or entries for a METIS of 32 bits."""


class Unavailable(Error, RuntimeError):
    """This build, or another library, lacks what the call needs: a method, a compression, a package, a version."""


class Stopped(Error, RuntimeError):
    """The progress function returned False, or the interpreter ends."""


class InternalError(Error, RuntimeError):
    """Something failed inside meshorder or inside a library that it uses."""


for _name in __all__:
    globals()[_name].__module__ = "meshorder"
