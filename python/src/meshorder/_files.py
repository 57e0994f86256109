# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Makes meshes from arrays, reads them from files and writes them to files."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

from . import _core
from ._meshes import Mesh, mesh_of_arrays
from ._options import whole
from .hosts import host_of


def make_mesh(points: Any, cells: Any = None) -> Mesh:
    """Makes a `Mesh` from arrays or from another library's mesh. Everything is copied.

    Args:
        points: one row of one to three coordinates for each vertex; or, if no cells are given, a mesh that `reorder` takes,
            with its data and sets.
        cells: cells of known types, in one of the forms that `order_mesh` takes.

    Returns:
        The mesh; its ``notes`` name the data that were left out. If ``points`` is a `Mesh`, that mesh itself.

    Raises:
        InvalidArgument: faulty arrays, an object that is not a mesh, cells of unknown types.
        TooLarge: 2³¹ or more vertices or cells.
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

    Files in formats that meshorder does not have are read by meshio if it is installed; the mesh's notes say so.

    Args:
        source: the path of a file, or its bytes.
        format: name of the format, "gmsh" or "vtu"; None: by the extension, or by the first bytes.
        memory_limit: limit in bytes on memory for values that the file holds in a shorter form only, such as compressed
            ones; None: 256 MiB plus 100 times the file's size, but at most three quarters of the memory. Files
            that meshio reads have no limit.
        include_folders: a folder, or several, besides the file's own, from which other files that it names may be
                read.

    Returns:
        The mesh; its ``notes`` say what the reader dropped or repaired.

    Raises:
        InputError: the file is missing, faulty or without cells, has an unknown extension, needs more than the limit,
            or names files in other folders. The message names the line or byte.
        InvalidArgument: an unknown format, a limit that is not a whole number of bytes.
        Unavailable: this build, or meshio, lacks a library that the file needs.

    Example:
        >>> mesh = meshorder.read(b"OFF 3 1 0  0 0 0  1 0 0  0 1 0  3 0 1 2")
        >>> mesh
        <Mesh: 3 vertices, 1 cells, off>
    """
    limit = None if memory_limit is None else whole(memory_limit, 2**64 - 1, "memory_limit")
    if isinstance(source, (bytes, bytearray, memoryview)):
        return Mesh(*_core.read_bytes(bytes(source), format or "", limit))
    from . import _foreign  # takes time to import

    path = os.fspath(source)
    foreign = _foreign.format_of_meshio(path, format or "")
    if foreign:
        return _foreign.read(path, foreign)
    # a single path must not be iterated: its letters, such as "/", would be taken for folders
    folders = [include_folders] if isinstance(include_folders, (str, os.PathLike)) else include_folders
    return Mesh(*_core.read(path, format or "", limit, [os.fspath(folder) for folder in folders]))


def write(mesh: Any, path: str | os.PathLike[str]) -> list[str]:
    """Writes a mesh to a file, with meshio if meshorder does not have the format.

    Args:
        mesh: a `Mesh`, or another mesh that `reorder` takes, which is converted to a `Mesh` first.
        path: the file; its extension sets the format. It is replaced once everything is written.

    Returns:
        Notes that name what was left out because the format cannot hold it, and say so if meshio wrote the file.

    Raises:
        InputError: an unknown extension, cells that the format cannot hold, a file that cannot be written.
        InvalidArgument: an object that is not a mesh, a faulty mesh.
        Unavailable: this build, or meshio, lacks a library that the format needs.
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
    """Returns the bytes of the file that `write` would make. Data that the format cannot hold are left out without a note.

    Args:
        mesh: as `write` takes it.
        format: name of a meshorder format that uses one file, "gmsh" or "vtu".

    Raises:
        InvalidArgument: an unknown format or one of several files, an object that is not a mesh.
        InputError: cells that the format cannot hold.
        Unavailable: this build lacks a library that the format needs.
    """
    made: bytes = (mesh if isinstance(mesh, Mesh) else make_mesh(mesh))._handle.to_bytes(format, "mesh")
    return made


def mesh_of(mesh: Any) -> Mesh:
    """Returns the `Mesh` in a file, or one made from a mesh that `reorder` takes."""
    return read(mesh) if isinstance(mesh, (str, os.PathLike)) else host_of(mesh).mesh()
