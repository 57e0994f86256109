# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files of formats that meshorder does not read or write itself: meshio does, where it is installed."""

from __future__ import annotations

import contextlib
import importlib.util
import io
from collections.abc import Callable
from pathlib import PurePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import InputError, InvalidArgument, Unavailable
from ._meshes import SHAPES, Mesh
from .hosts.meshio import MeshioMesh


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
    if importlib.util.find_spec("meshio") is None:
        what = f"format '{format}'" if format else f"extension '{PurePath(name).suffix}'"
        raise InputError(f"{path}: unknown {what}; meshio knows more than meshorder itself: pip install meshio")
    import meshio

    found = [kinds for end, kinds in meshio.extension_to_filetypes.items() if name.endswith(end)]
    if format:
        return format if any(format in kinds for kinds in meshio.extension_to_filetypes.values()) else None
    return str(found[-1][0]) if found else None


def read(path: str, format: str) -> Mesh:
    """Reads a file by meshio. The mesh's notes begin with that, and tell what was left out.

    Raises:
        InputError: meshio cannot read the file, or it holds cells that meshorder does not know.
    """
    import meshio

    try:
        open(path, "rb").close()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    found, warnings = _call(lambda: meshio.read(path, format), f"{path}: meshio cannot read this as {format}")
    try:
        mesh = MeshioMesh(found).mesh()
    except InvalidArgument as error:
        raise InputError(f"{path}: {error}") from error
    if len(mesh.shapes) == 0:
        raise InputError(f"{path}: meshio found no cells")
    mesh.notes[:0] = [
        f"read by meshio {meshio.__version__} as {format}: points, cells, data and sets; "
        "the rest of the file, numbers of nodes and elements among it, was left out",
        *warnings,
    ]
    return mesh


def write(mesh: Mesh, path: str, format: str) -> list[str]:
    """Writes a file by meshio, and reads it again to see what it holds.

    Returns:
        That meshio wrote it, and what is missing from the file.

    Raises:
        InputError: meshio cannot write these cells in this format.
    """
    import meshio

    given, notes = to_meshio(mesh)
    _, warnings = _call(lambda: meshio.write(path, given, format), f"{path}: meshio cannot write this as {format}")
    notes = [f"written by meshio {meshio.__version__} as {format}", *warnings, *notes]
    try:
        kept, _ = _call(lambda: meshio.read(path, format), "")
    except (InputError, Unavailable):
        return [*notes, "meshio cannot read this file again: what it holds was not verified"]
    return notes + _missing(given, kept)


def to_meshio(mesh: Mesh) -> tuple[Any, list[str]]:
    """A meshio.Mesh with the same data and sets, its cells grouped by type; and what it cannot hold."""
    import meshio

    widths = np.diff(mesh.offsets)
    kinds, first, kind_of = np.unique(
        np.stack([mesh.shapes.astype(np.int64), widths]), axis=1, return_index=True, return_inverse=True
    )
    members = [np.flatnonzero(kind_of.ravel() == kind) for kind in np.argsort(first)]
    blocks = []
    for cells in members:
        width = widths[cells[0]]
        rows = mesh.connectivity[mesh.offsets[cells][:, np.newaxis] + np.arange(width)]
        try:
            blocks.append(meshio.CellBlock(_type_name(SHAPES[mesh.shapes[cells[0]]], int(width)), rows))
        except KeyError:
            name = f"{SHAPES[mesh.shapes[cells[0]]]} of {width} vertices"
            raise InputError(f"meshio has no cells of the type {name}") from None
    notes = [] if (np.concatenate(members) == np.arange(len(widths))).all() else ["cells were grouped by type"]
    points = mesh.points[:, : mesh._handle.dimension]
    made = meshio.Mesh(np.array(points), blocks)
    _attach(made, mesh, members, notes)
    if len(mesh.vertex_ids) or len(mesh.cell_ids):
        notes.append("the numbers of vertices and cells were left out")
    notes += [f"{content}: left out" for content in mesh._handle.format_contents]
    return made, notes


def _attach(made: Any, mesh: Mesh, members: list[NDArray[Any]], notes: list[str]) -> None:
    for name, of_vertices, values, indices in mesh._handle.data:
        if isinstance(values, list) or len(indices):
            why = "its values are texts" if isinstance(values, list) else "it covers only some"
            notes.append(f"{'point' if of_vertices else 'cell'} data '{name}' was left out: {why}")
        elif of_vertices:
            made.point_data[name] = np.array(values)
        else:
            made.cell_data[name] = [values[cells] for cells in members]
    places = np.empty(len(mesh.shapes), dtype=np.int64)  # of each cell within its block
    block_of = np.empty(len(mesh.shapes), dtype=np.int64)
    for block, cells in enumerate(members):
        places[cells], block_of[cells] = np.arange(len(cells)), block
    for name, of_vertices, listed in mesh._handle.sets:
        if of_vertices:
            made.point_sets[name] = np.array(listed)
        else:
            made.cell_sets[name] = [places[listed[block_of[listed] == block]] for block in range(len(members))]


def _type_name(shape: str, width: int) -> str:
    name = {"tetrahedron": "tetra"}.get(shape, shape)
    linear = {"vertex": 1, "line": 2, "triangle": 3, "quad": 4, "tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}
    return name if name == "polygon" or linear.get(name) == width else f"{name}{width}"


def _missing(given: Any, kept: Any) -> list[str]:
    """What of one meshio.Mesh another lacks."""
    notes = []
    for kind in ("point_data", "cell_data", "point_sets", "cell_sets"):
        lost = [f"'{name}'" for name in getattr(given, kind) if name not in getattr(kept, kind)]
        if lost:
            notes.append(f"{kind.replace('_', ' ')} {', '.join(lost)}: not in the file under this name")
    if len(given.points) != len(kept.points):
        notes.append(f"{len(given.points)} points were written, {len(kept.points)} are in the file")
    counts = [sum(len(block.data) for block in mesh.cells) for mesh in (given, kept)]
    if counts[0] != counts[1]:
        notes.append(f"{counts[0]} cells were written, {counts[1]} are in the file")
    return notes


def _call(work: Callable[[], Any], fault: str) -> tuple[Any, list[str]]:
    """The result of a call to meshio and the warnings that it printed. meshio ends the process on some faults."""
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            result = work()
    except MemoryError:
        raise
    except ImportError as error:
        raise Unavailable(f"{fault}: {error}") from error
    except (Exception, SystemExit) as error:
        text = " ".join(printed.getvalue().split())
        said = text if isinstance(error, SystemExit) else f"{error} {text}".strip() or type(error).__name__
        raise InputError(f"{fault}: {said}") from error
    warnings = " ".join(printed.getvalue().split()).split("Warning: ")
    return result, [f"meshio: {warning.strip()}" for warning in warnings if warning.strip()]
