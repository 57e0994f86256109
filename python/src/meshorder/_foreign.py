# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Reads and writes files in formats that meshorder does not have, with meshio if it is installed.

Each written file is read again: notes name the data that are missing from it. If cells would be lost, no file is
written.
"""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import PurePath
from typing import Any

import numpy as np

from . import _core
from ._errors import InputError, InvalidArgument, Unavailable
from ._meshes import Mesh
from .hosts.meshio import MeshioMesh, to_meshio


def format_of_meshio(path: str, format: str = "") -> str | None:
    """Returns meshio's name of the format of a file; None for formats that meshorder has and for unknown ones.

    Args:
        path: the file, whose extension gives the format.
        format: name of the format, which overrides the extension; empty: none.

    Raises:
        InputError: meshorder does not have the format, and meshio is not installed.
    """
    ours = _core.formats()
    name = PurePath(path).name.lower()
    if format in [own for own, _, _ in ours] or (
        not format and name.endswith(tuple(end for _, extensions, _ in ours for end in extensions))
    ):
        return None
    if not format and not PurePath(name).suffix:
        return None
    try:
        import meshio
    except ImportError:
        what = f"format '{format}'" if format else f"extension '{PurePath(name).suffix}'"
        raise InputError(
            f"{path}: unknown {what}; with meshio, meshorder takes more formats: pip install meshio"
        ) from None
    found = [kinds for end, kinds in meshio.extension_to_filetypes.items() if name.endswith(end)]
    if format:
        return format if any(format in kinds for kinds in meshio.extension_to_filetypes.values()) else None
    return str(found[-1][0]) if found else None


def read(path: str, format: str) -> Mesh:
    """Reads a file with meshio and returns a mesh whose notes say so and name what was left out.

    Raises:
        InputError: meshio cannot read the file, or it holds no cells or cells of a type that meshorder does not know.
        Unavailable: meshio needs another package for the format.
    """
    found, notes = read_meshio(path, format)
    try:
        mesh = MeshioMesh(found).mesh()
    except InvalidArgument as error:
        raise InputError(f"{path}: {error}") from error
    if len(mesh.shapes) == 0:
        raise InputError(f"{path}: meshio found no cells")
    mesh.notes[:0] = notes
    return mesh


def write(mesh: Mesh, path: str, format: str) -> list[str]:
    """Writes a file with meshio and returns notes that say so and name what is missing from the file.

    Raises:
        InputError, Unavailable: as `write_meshio`.
    """
    made, _, notes = to_meshio(mesh)
    written, *missing = write_meshio(made, path, format)
    return [written, *notes, *missing]


def read_meshio(path: str, format: str) -> tuple[Any, list[str]]:
    """Reads a file with meshio.

    Returns:
        The meshio.Mesh, and notes: that meshio read the file, and the messages of meshio.

    Raises:
        InputError: the file is missing, or meshio cannot read it.
        Unavailable: meshio needs another package for the format.
    """
    import meshio

    try:
        open(path, "rb").close()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    notes = [
        f"read by meshio {meshio.__version__} as {format}: points, cells, data and sets; "
        "the rest of the file, numbers of nodes and elements among it, was left out"
    ]
    with _meshios_words(path, notes, f"read this as {format}"):
        mesh = meshio.read(path, format)
    return mesh, notes


def write_meshio(mesh: Any, path: str, format: str, strict: bool = False) -> list[str]:
    """Writes a meshio.Mesh to a file and reads the file again to find what is missing from it.

    Args:
        mesh: the mesh to write.
        path: where to write it.
        format: meshio's name of the format.
        strict: True refuses to lose cells, arrays or sets.

    Returns:
        Notes: that meshio wrote the file, the messages of meshio, and what the file does not hold.

    Raises:
        InputError: meshio cannot write the mesh; or cells would be lost, or anything at all if ``strict``; the file is then
            not made.
        Unavailable: meshio needs another package for the format.
    """
    import meshio

    notes = [f"written by meshio {meshio.__version__} as {format}"]
    with folder_beside(path) as folder:
        made = os.path.join(folder, os.path.basename(path))
        with _meshios_words(path, notes, f"write this as {format}"):
            meshio.write(made, _shallow_copy(mesh), format)
        try:
            with _meshios_words(path, [], "read it again"):
                again = meshio.read(made, format)
        except (InputError, Unavailable):
            lost = ["meshio cannot read the file that it wrote: its contents were not verified"]
        else:
            lost = list(_what_is_lost(mesh, again, path))
            notes += _what_is_rounded(mesh, again)
        if strict and lost:
            raise InputError(f"{path}: {lost[0]}; file not written: --strict forbids data loss")
        notes += lost
        for name in os.listdir(folder):
            os.replace(os.path.join(folder, name), os.path.join(os.path.dirname(path), name))
    return notes


@contextlib.contextmanager
def folder_beside(path: str) -> Iterator[str]:
    """Makes a temporary folder in the folder of a file that will be written, and removes it at the end.

    Raises:
        InputError: the folder cannot be made.
    """
    target = os.path.dirname(path) or os.curdir
    try:
        folder = tempfile.mkdtemp(prefix=".meshorder-", dir=target)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextlib.contextmanager
def _meshios_words(path: str, notes: list[str], what: str) -> Iterator[None]:
    """Runs meshio: adds its messages to the notes, and raises InputError or Unavailable for all its failures."""
    printed = io.StringIO()
    width = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "1000"  # long lines, so that meshio does not break them
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            yield
    except ImportError as error:
        raise Unavailable(f"{path}: meshio needs the package {error.name} to {what}; install that, too") from None
    except MemoryError:
        raise
    except (Exception, SystemExit) as error:  # meshio calls sys.exit for some faults
        words = "" if isinstance(error, SystemExit) else str(error)
        reason = " ".join((words or printed.getvalue() or type(error).__name__).split())
        raise InputError(f"{path}: meshio cannot {what}: {reason}") from None
    finally:
        if width is None:
            del os.environ["COLUMNS"]
        else:
            os.environ["COLUMNS"] = width
    for line in printed.getvalue().splitlines():
        if line.strip():
            notes.append(f"meshio: {line.strip().removeprefix('Warning: ')}")


def _shallow_copy(mesh: Any) -> Any:
    """Returns a mesh with the same arrays but its own lists and dictionaries, because meshio's writers change them."""
    return type(mesh)(
        mesh.points,
        list(mesh.cells),
        dict(mesh.point_data),
        {name: list(blocks) for name, blocks in mesh.cell_data.items()},
        dict(mesh.field_data),
        dict(mesh.point_sets),
        {name: list(blocks) for name, blocks in mesh.cell_sets.items()},
        mesh.gmsh_periodic,
        mesh.info,
    )


def _counts(mesh: Any) -> Counter[str]:
    """Returns the number of cells of each type."""
    counts: Counter[str] = Counter()
    for block in mesh.cells:
        counts[block.type] += len(block.data)
    return +counts


def _what_is_lost(mesh: Any, again: Any, path: str) -> Iterator[str]:
    """Yields a note for each difference between a mesh and the same mesh read from the file.

    Raises:
        InputError: cells are missing.
    """
    missing = _counts(mesh) - _counts(again)
    extra = _counts(again) - _counts(mesh)
    if missing.total() > extra.total():
        listed = ", ".join(f"{count} of type {name}" for name, count in missing.items())
        raise InputError(f"{path}: the format would lose cells: {listed}; choose another format")
    if missing:
        yield f"cells of type {', '.join(missing)} become {', '.join(extra)}"
    if len(again.points) != len(mesh.points):
        yield f"the file has {len(again.points)} points instead of {len(mesh.points)}"
    for what in ("point_data", "cell_data", "point_sets", "cell_sets", "field_data"):
        names = [f"'{name}'" for name in getattr(mesh, what) if name not in getattr(again, what)]
        if names:
            yield f"the file lacks the {what.replace('_', ' ')} {', '.join(names)}"
    for what in ("point_sets", "cell_sets"):
        for name in getattr(mesh, what).keys() & getattr(again, what).keys():
            before, after = (_member_count(getattr(one, what)[name]) for one in (mesh, again))
            if before != after:
                yield f"the {what.replace('_', ' ')[:-1]} '{name}' has {after} members in the file instead of {before}"


def _what_is_rounded(mesh: Any, again: Any) -> Iterator[str]:
    if len(again.points) != len(mesh.points):
        return
    width = min(mesh.points.shape[1], again.points.shape[1])
    error = np.abs(again.points[:, :width] - mesh.points[:, :width]).max(initial=0)
    if error > 0:
        yield f"coordinates are rounded, by at most {error:.2g}"


def _member_count(members: Any) -> int:
    """Returns the number of members of a set; a set of cells has a list with an array for each block."""
    if isinstance(members, list):
        return sum(len(part) for part in members if part is not None)
    return len(members)
