# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Meshes from arrays and files, and into files."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

from . import _core
from ._meshes import Mesh, mesh_of_arrays
from .hosts import host_of


def make_mesh(points: Any, cells: Any = None) -> Mesh:
    """A mesh of arrays as of `order_mesh`, which are copied.

    Without cells: of a mesh as of `reorder`, with its data and sets; the notes tell what was left out.
    """
    if cells is None:
        return host_of(points).mesh()
    return mesh_of_arrays(points, cells)


def read(
    source: str | os.PathLike[str] | bytes,
    format: str | None = None,
    *,
    memory_limit: int | None = None,
    include_folders: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] = (),
) -> Mesh:
    """Reads a mesh from a file, or from the bytes of one.

    Args:
        source: a path or the bytes.
        format: name of the format; None: by the extension, of bytes by the first of them. Files of formats that are not
            ours are read by meshio, where it is installed; the mesh's notes begin with that.
        memory_limit: bytes that a file may take for what it claims rather than holds, such as compressed values; None:
            256 MiB and 100 times the file, at most three quarters of the memory. meshio knows no limit.
        include_folders: a folder, or several, where files may be that the mesh names to be read with it, besides its own.

    Raises:
        InputError: the file is missing or faulty, claims more than the limit or names files elsewhere; the message
            names line or byte.
    """
    if isinstance(source, (bytes, bytearray, memoryview)):
        return Mesh(*_core.read_bytes(bytes(source), format or "", memory_limit))
    from . import _foreign  # takes time to import

    path = os.fspath(source)
    foreign = _foreign.format_of_meshio(path, format or "")
    if foreign:
        return _foreign.read(path, foreign)
    # the letters of a path are folders, too: "/", say
    folders = [include_folders] if isinstance(include_folders, (str, os.PathLike)) else include_folders
    return Mesh(*_core.read(path, format or "", memory_limit, [os.fspath(folder) for folder in folders]))


def write(mesh: Any, path: str | os.PathLike[str]) -> list[str]:
    """Writes a mesh as of `reorder` in the format that the extension names; by meshio where it is not ours.

    Returns:
        What was left out, of a mesh that is no `Mesh` also on the way to one; and that meshio wrote, if it did.
    """
    if not isinstance(mesh, Mesh):
        made = make_mesh(mesh)
        return made.notes + write(made, path)
    from . import _foreign  # takes time to import

    foreign = _foreign.format_of_meshio(os.fspath(path))
    if foreign:
        return _foreign.write(mesh, os.fspath(path), foreign)
    notes: list[str] = mesh._handle.write(os.fspath(path))
    return notes


def to_bytes(mesh: Any, format: str) -> bytes:
    """The bytes of the file that `write` would make, in a format of our own."""
    made: bytes = (mesh if isinstance(mesh, Mesh) else make_mesh(mesh))._handle.to_bytes(format, "mesh")
    return made


def mesh_of(mesh: Any) -> Mesh:
    """The mesh of a path, or of what `reorder` takes."""
    return read(mesh) if isinstance(mesh, (str, os.PathLike)) else host_of(mesh).mesh()
