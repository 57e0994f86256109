# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Makes the table of what each format keeps: writes small meshes to every format, reads them back and compares.

A loss that the writer did not name is an error, `SilentLoss`; a wider type of number is none.
"""

from __future__ import annotations

import dataclasses
import pathlib
import tempfile
from collections.abc import Callable
from typing import Any

import meshorder
import numpy as np

VTK_TYPES = {
    "vertex": 1, "line": 3, "triangle": 5, "polygon": 7, "quad": 9, "tetrahedron": 10, "hexahedron": 12, "wedge": 13,
    "pyramid": 14, "triangle6": 22, "tetrahedron10": 24,
}  # fmt: skip
VTK_NAMES = {
    "float64": "Float64", "float32": "Float32", "int8": "Int8", "uint8": "UInt8", "int16": "Int16", "uint16": "UInt16",
    "int32": "Int32", "uint32": "UInt32", "int64": "Int64", "uint64": "UInt64",
}  # fmt: skip
YES, NO = "yes", "–"


class SilentLoss(Exception):
    """A writer left something out and did not say so."""


@dataclasses.dataclass
class Probe:
    """Something that a mesh may have.

    Attributes:
        row: what the table calls it.
        meshes: the same thing on several meshes, of which the first whose cells a format can hold is taken.
        compare: returns the answer for the mesh before and after: YES, NO or words between them.
    """

    row: str
    meshes: list[bytes]
    format: str
    compare: Callable[[meshorder.Mesh, meshorder.Mesh], str]


def vtu(
    cells: list[tuple[str, list[int]]], points: Any, point_data: dict[str, Any] | None = None,
    cell_data: dict[str, Any] | None = None,
) -> bytes:  # fmt: skip
    """A VTK XML file as text."""

    def array(name: str, values: Any) -> str:
        values = np.asarray(values)
        width = values.shape[1] if values.ndim == 2 else 1
        text = " ".join(repr(number) for number in values.ravel().tolist())
        return (
            f'<DataArray type="{VTK_NAMES[values.dtype.name]}" Name="{name}" NumberOfComponents="{width}" '
            f'format="ascii">'
            f"{text}</DataArray>"
        )

    offsets = np.cumsum([len(vertices) for _, vertices in cells])
    connectivity = np.array([vertex for _, vertices in cells for vertex in vertices])
    types = np.array([VTK_TYPES[name] for name, _ in cells], dtype=np.uint8)
    of_points = "".join(array(*item) for item in (point_data or {}).items())
    of_cells = "".join(array(*item) for item in (cell_data or {}).items())
    return (
        '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">'
        "<UnstructuredGrid>"
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">'
        f"<Points>{array('Points', np.asarray(points, dtype=float))}</Points>"
        f"<Cells>{array('connectivity', connectivity)}{array('offsets', offsets)}{array('types', types)}</Cells>"
        f"<PointData>{of_points}</PointData><CellData>{of_cells}</CellData></Piece></UnstructuredGrid></VTKFile>"
    ).encode()


# a cube with its centre on top, and a base of each kind on it
CUBE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
TETRAHEDRA = [("tetrahedron", [0, 1, 3, 4]), ("tetrahedron", [1, 2, 3, 6]), ("tetrahedron", [1, 3, 4, 6]),
              ("tetrahedron", [1, 4, 5, 6]), ("tetrahedron", [3, 4, 6, 7])]  # fmt: skip
TRIANGLES = [("triangle", [0, 1, 2]), ("triangle", [0, 2, 3]), ("triangle", [0, 4, 5]), ("triangle", [0, 5, 1]),
             ("triangle", [4, 6, 5]), ("triangle", [4, 7, 6])]  # fmt: skip
SECOND_ORDER = [
    [0, 0, 0],
    [2, 0, 0],
    [0, 2, 0],
    [0, 0, 2],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [0, 1, 1],
]
FLAT = [[x, y, 0] for x, y, _ in CUBE]
CELLS_ON_CUBE = {
    "vertices, as cells": [("vertex", [0])],
    "lines": [("line", [0, 1])],
    "triangles": [("triangle", [0, 1, 2])],
    "quadrilaterals": [("quad", [0, 1, 2, 3])],
    "polygons": [("polygon", [0, 1, 2, 6, 3])],
    "tetrahedra": [("tetrahedron", [0, 1, 3, 4])],
    "pyramids": [("pyramid", [0, 1, 2, 3, 4])],
    "wedges": [("wedge", [0, 1, 3, 4, 5, 7])],
    "hexahedra": [("hexahedron", [0, 1, 2, 3, 4, 5, 6, 7])],
}


def gmsh(cells: str) -> bytes:
    """Gmsh's file with numbers that have gaps, and an array on two of its vertices."""
    return f"""$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
10 0 0 0
20 1 0 0
35 0 1 0
40 0 0 1
$EndNodes
$Elements
{cells}
$EndElements
$NodeData
1
"probe"
1
0.0
3
0
1
2
20 1.5
35 2.5
$EndNodeData
""".encode()


NUMBERED = [gmsh("1\n7 4 2 0 1 10 20 35 40"), gmsh("2\n7 2 2 0 1 10 35 20\n9 2 2 0 1 10 20 40")]
VEGA = b"""*VERTICES
4 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
*ELEMENTS
TET
2 4 0
1 1 2 3 4
2 1 3 2 4
*SET clamp
2
"""


def places(mesh: meshorder.Mesh) -> list[tuple[str, Any]]:
    """The cells by the coordinates of their vertices, in whatever order."""
    return sorted(
        (shape, tuple(map(tuple, np.round(mesh.points[row], 6).tolist()))) for shape, rows in mesh.cells for row in rows
    )


def same_cells(before: meshorder.Mesh, after: meshorder.Mesh) -> str:
    return YES if places(before) == places(after) else NO


def as_another(mesh: meshorder.Mesh, values: Any) -> str:
    """What to say where values are not in their place: "array" where some array has them, NO otherwise."""
    arrays = [*mesh.point_data.values(), *mesh.cell_data.values()]
    columns = [column for array in arrays if array.dtype.kind in "iuf" for column in (array, *np.atleast_2d(array.T))]
    found = any(np.shape(one) == np.shape(values) and np.array_equal(one, values, equal_nan=True) for one in columns)
    return "array" if found else NO


def same_array(name: str, of: str) -> Callable[[meshorder.Mesh, meshorder.Mesh], str]:
    def compare(before: meshorder.Mesh, after: meshorder.Mesh) -> str:
        old, new = getattr(before, of)[name], getattr(after, of).get(name)
        if new is None or not np.array_equal(old, new):
            told = as_another(after, old)
            return "unnamed" if told != NO and name != "label" else told
        return YES if new.dtype == old.dtype else str(new.dtype)

    return compare


def same_partial_array(before: meshorder.Mesh, after: meshorder.Mesh) -> str:
    (values, rows), *_ = [(values, rows) for _, _, values, rows in before._handle.data if len(rows)]
    for _, _, new_values, new_rows in after._handle.data:
        if len(new_rows) and new_rows.tolist() == rows.tolist() and new_values.tolist() == values.tolist():
            return YES
    filled = np.full(len(before.points), np.nan)
    filled[rows] = values
    return "filled" if as_another(after, filled) != NO else NO


def same_sets(before: meshorder.Mesh, after: meshorder.Mesh) -> str:
    old = {name: sorted(members.tolist()) for name, members in before.sets.items()}
    new = {name: sorted(members.tolist()) for name, members in after.sets.items()}
    return YES if old and old.items() <= new.items() else NO


def same_ids(of: str) -> Callable[[meshorder.Mesh, meshorder.Mesh], str]:
    def compare(before: meshorder.Mesh, after: meshorder.Mesh) -> str:
        ids = getattr(before, of)
        return YES if np.array_equal(ids, getattr(after, of)) else as_another(after, ids)

    return compare


def on_both(make: Callable[[int, int], tuple[dict[str, Any], dict[str, Any]]]) -> list[bytes]:
    """The same data on tetrahedra, and on triangles for formats of surfaces."""
    return [vtu(cells, CUBE, *make(len(CUBE), len(cells))) for cells in (TETRAHEDRA, TRIANGLES)]


def probes() -> dict[str, list[Probe]]:
    """All rows of the table, by section."""
    cells = [Probe(row, [vtu(cell, CUBE), vtu(cell, FLAT)], "vtu", same_cells) for row, cell in CELLS_ON_CUBE.items()]
    cells.append(Probe(
        "second-order cells", [vtu([("tetrahedron10", list(range(10)))], SECOND_ORDER),
                               vtu([("triangle6", list(range(6)))], SECOND_ORDER)], "vtu", same_cells))  # fmt: skip
    mixed = [TETRAHEDRA[:1] + TRIANGLES[2:3], TRIANGLES[:1] + [("quad", [4, 5, 6, 7])]]
    cells.append(Probe("cells of several types", [vtu(one, CUBE) for one in mixed], "vtu", same_cells))

    def numbers(n: int, kind: str, width: int = 1) -> Any:
        values = (np.arange(n * width) % 100 + (0.5 if kind.startswith("float") else 0)).astype(kind)
        return values.reshape(n, width) if width > 1 else values

    data = []
    for of, title in (("point_data", "vertices"), ("cell_data", "cells")):

        def made(kind: str, width: int, of: str = of) -> list[bytes]:
            def make(vertices: int, cells: int) -> tuple[dict[str, Any], dict[str, Any]]:
                array = {"a": numbers(vertices if of == "point_data" else cells, kind, width)}
                return (array, {}) if of == "point_data" else ({}, array)

            return on_both(make)

        rows = [("real numbers", "float64", 1), ("vectors", "float64", 3), ("single precision", "float32", 1),
                ("whole numbers", "int32", 1), ("bytes", "uint8", 1)]  # fmt: skip
        for name, kind, width in rows:
            data.append(Probe(f"{name} on {title}", made(kind, width), "vtu", same_array("a", of)))
    data.append(Probe("arrays on some vertices only", NUMBERED, "gmsh", same_partial_array))

    label = [lambda v, c: ({"label": numbers(v, "int32")}, {}), lambda v, c: ({}, {"label": numbers(c, "int32") + 1})]
    names = [
        Probe("labels of vertices", on_both(label[0]), "vtu", same_array("label", "point_data")),
        Probe("labels of cells", on_both(label[1]), "vtu", same_array("label", "cell_data")),
        Probe("named sets of cells", [VEGA], "vega", same_sets),
        Probe("the file's numbers of vertices", NUMBERED, "gmsh", same_ids("vertex_ids")),
        Probe("the file's numbers of cells", NUMBERED, "gmsh", same_ids("cell_ids")),
    ]
    return {"Cells": cells, "Arrays": data, "Labels, sets and numbers": names}


def answer(probe: Probe, extension: str, folder: pathlib.Path) -> tuple[str, list[str]]:
    """What becomes of the probe in a file with that extension, and what the writer said of it."""
    path, refusal = pathlib.Path(tempfile.mkdtemp(dir=folder)) / f"mesh{extension}", ""
    for source in probe.meshes:
        before = meshorder.read(source, probe.format)
        try:
            notes = meshorder.write(before, path)
        except meshorder.Error as refused:
            refusal = str(refused)
            continue
        told = probe.compare(before, meshorder.read(path))
        if told == NO and not notes:
            raise SilentLoss(f"{extension}: {probe.row}: '{told}', and the writer says nothing")
        return told, notes
    return NO, [refusal]


def formats_table() -> str:
    """Returns the table as Markdown: a row for each thing that a mesh may have, a column for each format."""
    formats = [(name, extensions) for name, extensions, _ in meshorder._core.formats()]
    lines: list[str] = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for title, rows in probes().items():
            lines += [
                f"| {title} | {' | '.join(f'`{e[0]}`' for _, e in formats)} |",
                f"| --- {'| :-: ' * len(formats)}|",
            ]
            for probe in rows:
                told = [answer(probe, extensions[0], folder)[0] for _, extensions in formats]
                lines.append(f"| {probe.row} | {' | '.join(told)} |")
            lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    print(formats_table())
