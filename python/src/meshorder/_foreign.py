# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files of formats that meshorder does not read or write itself: meshio does, where it is installed.

Nothing is lost in silence: what a format does not give back, once it is written, is named; where cells would be lost,
no file is written.
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
    """meshio's name of the format that it must read or write a file in; None for formats of our own and unknown ones.

    Raises:
        InputError: the format is not ours, and meshio is not installed.
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
            f"{path}: unknown {what}; meshio knows more than meshorder itself: pip install meshio"
        ) from None
    found = [kinds for end, kinds in meshio.extension_to_filetypes.items() if name.endswith(end)]
    if format:
        return format if any(format in kinds for kinds in meshio.extension_to_filetypes.values()) else None
    return str(found[-1][0]) if found else None


def read(path: str, format: str) -> Mesh:
    """Reads a file by meshio. The mesh's notes begin with that, and tell what was left out.

    Raises:
        InputError: meshio cannot read the file, or it holds cells that meshorder does not know.
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
    """Writes a file by meshio. Returns that, and what is missing from the file.

    Raises:
        InputError, Unavailable: as `write_meshio`.
    """
    made, _, notes = to_meshio(mesh)
    written, *missing = write_meshio(made, path, format)
    return [written, *notes, *missing]


def read_meshio(path: str, format: str) -> tuple[Any, list[str]]:
    """A meshio.Mesh of a file; that meshio read it, and what meshio says of it.

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
    """Writes a meshio.Mesh, and reads it again to see what the format holds of it.

    Args:
        mesh: of meshio.
        path: of the file.
        format: by meshio's name.
        strict: allows no loss of cells, arrays and sets.

    Returns:
        That meshio wrote it, what meshio says, and what the file does not hold.

    Raises:
        InputError: meshio cannot write it, or cells would be lost, or anything where that is not allowed. There is no
            file then.
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
            lost = ["meshio cannot read this file again: what it holds was not verified"]
        else:
            lost = list(_what_is_lost(mesh, again, path))
            notes += _what_is_rounded(mesh, again)
        if strict and lost:
            raise InputError(f"{path}: {lost[0]}; no loss is allowed")
        notes += lost
        for name in os.listdir(folder):
            os.replace(os.path.join(folder, name), os.path.join(os.path.dirname(path), name))
    return notes


@contextlib.contextmanager
def folder_beside(path: str) -> Iterator[str]:
    """A folder to write in, which is gone at the end; on the disk of the file that is to be written.

    Raises:
        InputError: nothing can be written there.
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
    """Turns what meshio prints into notes, and its many ways to fail into an InputError."""
    printed = io.StringIO()
    width = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "1000"  # its lines are not broken then
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            yield
    except ImportError as error:
        raise Unavailable(f"{path}: meshio needs the package {error.name} to {what}; install that, too") from None
    except MemoryError:
        raise
    except (Exception, SystemExit) as error:  # meshio ends the process on some faults
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
    """A mesh with the same arrays; meshio's writers change the lists and dictionaries of the one that they write."""
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
    counts: Counter[str] = Counter()
    for block in mesh.cells:
        counts[block.type] += len(block.data)
    return +counts


def _what_is_lost(mesh: Any, again: Any, path: str) -> Iterator[str]:
    missing = _counts(mesh) - _counts(again)
    extra = _counts(again) - _counts(mesh)
    if missing.total() > extra.total():
        listed = ", ".join(f"{count} of type {name}" for name, count in missing.items())
        raise InputError(f"{path}: the format would lose cells: {listed}; choose another")
    if missing:
        yield f"cells of type {', '.join(missing)} become {', '.join(extra)}"
    if len(again.points) != len(mesh.points):
        yield f"the file has {len(again.points)} points instead of {len(mesh.points)}"
    for what in ("point_data", "cell_data", "point_sets", "cell_sets", "field_data"):
        names = [f"'{name}'" for name in getattr(mesh, what) if name not in getattr(again, what)]
        if names:
            yield f"the file does not give back the {what.replace('_', ' ')} {', '.join(names)}"
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
    """Of a set of points, or of one of cells, which has a list for each block."""
    if isinstance(members, list):
        return sum(len(part) for part in members if part is not None)
    return len(members)
