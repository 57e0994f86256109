# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files that meshio reads and writes and meshorder does not.

Nothing is lost in silence: what a format does not give back, once it is written, is named; where cells would be lost,
no file is written.
"""

from __future__ import annotations

import contextlib
import io
import os
import pathlib
import shutil
import tempfile
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from . import _core
from ._errors import InputError, Unavailable


def is_own(path: str) -> bool:
    """Whether the extension is that of a format of meshorder's own."""
    return pathlib.PurePath(path).suffix.lower() in own_extensions()


def own_extensions() -> set[str]:
    """Extensions of meshorder's own formats: ".vtu" and others."""
    return {extension for _, extensions, _ in _core.formats() for extension in extensions}


def is_meshios(path: str) -> bool:
    """Whether the extension is one of meshio's and none of meshorder's.

    Raises:
        Unavailable: meshio is not installed, and the extension is not meshorder's.
    """
    suffixes = pathlib.PurePath(path).suffixes
    if not suffixes or is_own(path):
        return False
    known = _meshio(path)._helpers.extension_to_filetypes
    return any("".join(suffixes[k:]).lower() in known for k in range(len(suffixes)))


def _meshio(path: str) -> Any:
    try:
        import meshio
    except ImportError:
        extension = pathlib.PurePath(path).suffix
        raise Unavailable(
            f"{path}: the extension '{extension}' is none of meshorder's; `pip install meshio` adds meshio's formats"
        ) from None
    return meshio


def read(path: str) -> tuple[Any, list[str]]:
    """A meshio.Mesh of a file, and what meshio says of it.

    Raises:
        InputError: the file is missing, or meshio cannot read it.
        Unavailable: meshio, or a package that it needs for the format, is not installed.
    """
    meshio = _meshio(path)
    if not os.path.exists(path):
        raise InputError(f"{path}: no such file")
    said = [f"{path}: read through meshio: points, cells, data and sets; whatever else the file holds is left out"]
    with _meshios_words(path, said, "read"):
        mesh = meshio.read(path)
    return mesh, said


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


def write(mesh: Any, path: str) -> list[str]:
    """Writes a meshio.Mesh, and reads it again to see what the format holds of it.

    Returns:
        What it does not hold, and what meshio says.

    Raises:
        InputError: meshio cannot write it, or cells would be lost. There is no file then.
    """
    meshio = _meshio(path)
    said = [f"{path}: written through meshio"]
    with folder_beside(path) as folder:
        made = os.path.join(folder, os.path.basename(path))
        words: list[str] = []
        with _meshios_words(path, words, "write"):
            meshio.write(made, _shallow_copy(mesh))
        said += words
        try:
            with _meshios_words(path, [], "read"):
                again = meshio.read(made)
        except InputError:
            said.append(f"{path}: cannot be read again, so what it holds has not been checked")
        else:
            said += [f"{path}: {fault}" for fault in _what_is_lost(mesh, again, path)]
        for name in os.listdir(folder):
            os.replace(os.path.join(folder, name), os.path.join(os.path.dirname(path), name))
    return said


@contextlib.contextmanager
def _meshios_words(path: str, said: list[str], what: str) -> Iterator[None]:
    """Turns what meshio prints into notes, and its many ways to fail into an InputError."""
    printed = io.StringIO()
    width = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "1000"  # its lines are not broken then
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            yield
    except ImportError as error:
        raise Unavailable(f"{path}: meshio needs the package {error.name} to {what} it; install that, too") from None
    except (Exception, SystemExit) as error:
        words = "" if isinstance(error, SystemExit) else str(error)
        reason = " ".join((words or printed.getvalue() or type(error).__name__).split())
        raise InputError(f"{path}: meshio cannot {what} it: {reason}") from None
    finally:
        if width is None:
            del os.environ["COLUMNS"]
        else:
            os.environ["COLUMNS"] = width
    for line in printed.getvalue().splitlines():
        if line.strip():
            said.append(f"{path}: meshio: {line.strip().removeprefix('Warning: ')}")


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
        yield f"has {len(again.points)} points instead of {len(mesh.points)}"
    else:
        width = min(mesh.points.shape[1], again.points.shape[1])
        error = np.abs(again.points[:, :width] - mesh.points[:, :width]).max(initial=0)
        if error > 0:
            yield f"coordinates are rounded, by at most {error:.2g}"
    for what in ("point_data", "cell_data", "point_sets", "cell_sets", "field_data"):
        names = [name for name in getattr(mesh, what) if name not in getattr(again, what)]
        if names:
            yield f"does not give back the {what.replace('_', ' ')} {', '.join(names)}"
    for what in ("point_sets", "cell_sets"):
        for name in getattr(mesh, what).keys() & getattr(again, what).keys():
            before, after = (_member_count(getattr(one, what)[name]) for one in (mesh, again))
            if before != after:
                yield f"the {what.replace('_', ' ')[:-1]} {name} has {after} members there instead of {before}"


def _member_count(members: Any) -> int:
    """Of a set of points, or of one of cells, which has a list for each block."""
    if isinstance(members, list):
        return sum(len(part) for part in members if part is not None)
    return len(members)
