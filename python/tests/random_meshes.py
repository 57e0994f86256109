# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Random meshes with arrays, labels, sets, names and numbers, as hypothesis draws them."""

import unicodedata
from typing import Any

import meshorder
import numpy as np
from hypothesis import strategies as st

#: corners of the reference cells, in VTK's order; only in wedges, the first triangle faces inward
CORNERS: dict[str, list[Any]] = {
    "vertex": [(0, 0, 0)],
    "line": [(0, 0, 0), (1, 0, 0)],
    "triangle": [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
    "quad": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
    "polygon": [(0, 0, 0), (1, 0, 0), (1.5, 0.5, 0), (1, 1, 0), (0, 1, 0)],
    "tetrahedron": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "pyramid": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)],
    "wedge": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)],
    "hexahedron": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
}
#: for each further node, the corners between which it lies: first nodes of edges, then of faces, then of the interior
_QUAD_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
_HEXAHEDRON_EDGES = [*_QUAD_EDGES, (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
_WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
MIDDLES: dict[tuple[str, int], list[Any]] = {
    ("line", 3): [(0, 1)],
    ("triangle", 6): [(0, 1), (1, 2), (2, 0)],
    ("quad", 8): _QUAD_EDGES,
    ("quad", 9): [*_QUAD_EDGES, (0, 1, 2, 3)],
    ("tetrahedron", 10): [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    ("pyramid", 13): [*_QUAD_EDGES, (0, 4), (1, 4), (2, 4), (3, 4)],
    ("wedge", 15): _WEDGE_EDGES,
    ("wedge", 18): [*_WEDGE_EDGES, (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    ("hexahedron", 20): _HEXAHEDRON_EDGES,
    ("hexahedron", 27): [
        *_HEXAHEDRON_EDGES, (0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7),
        tuple(range(8)),
    ],
}  # fmt: skip
GMSH_TYPES = {
    "vertex": 15, "line": 1, "triangle": 2, "quad": 3, "tetrahedron": 4, "hexahedron": 5, "wedge": 6, "pyramid": 7,
}  # fmt: skip
DTYPES = ["f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"]
SEPARATORS = " \t\n\r'\"\\/,;:#!$%&<>=*|[](){}+-._@~^`?\x00\x1b\x7f\u0085\u2028\ufeff"


def reference(shape, width):
    """The nodes of the reference cell: width × 3."""
    corners = np.array(CORNERS[shape], dtype=float)
    middles = [corners[list(ends)].mean(axis=0) for ends in MIDDLES.get((shape, width), [])]
    return np.array([*corners, *middles])


LINEAR = [(shape, len(corners)) for shape, corners in CORNERS.items()]
TYPES = [*LINEAR, *MIDDLES]

plain_names = st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,11}", fullmatch=True)
_categories: Any = sorted({unicodedata.category(chr(code)) for code in range(0x3000)} - {"Cs"})
odd_names = st.one_of(
    st.text(st.sampled_from(SEPARATORS), max_size=4),
    st.text(st.one_of(st.sampled_from(SEPARATORS), st.characters(codec="ascii")), max_size=12),
    st.sampled_from(_categories).flatmap(
        lambda category: st.text(st.characters(codec="utf-8", categories=[category]), max_size=8)
    ),
    st.text(st.characters(codec="utf-8"), max_size=80),
    plain_names.map(lambda name: name + "\\"),
)


@st.composite
def values(draw, rows, dtype, components, finite):
    count = rows * components
    if dtype.startswith("f"):
        numbers = st.floats(width=32 if dtype == "f4" else 64, allow_nan=not finite, allow_infinity=not finite)
    else:
        limits = np.iinfo(dtype)
        numbers = st.one_of(st.integers(0, 5), st.integers(int(limits.min), int(limits.max))).map(
            lambda number: min(max(number, int(limits.min)), int(limits.max))
        )
    array = np.array(draw(st.lists(numbers, min_size=count, max_size=count)), dtype=dtype)
    return array.reshape(rows, components) if components > 1 else array


def gmsh_file(points, cells, vertex_ids, cell_ids, partial):
    """Gmsh 2.2 of linear cells, with numbers of their own and an array on some vertices."""
    numbers = {v: vertex_ids[v] for v in range(len(points))}
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
    lines += [f"{numbers[v]} {x!r} {y!r} {z!r}" for v, (x, y, z) in enumerate(points.tolist())]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    for number, (shape, row) in zip(cell_ids, cells):
        lines.append(" ".join(map(str, [number, GMSH_TYPES[shape], 2, 0, 1, *(numbers[v] for v in row)])))
    lines += ["$EndElements"]
    if partial:
        lines += ["$NodeData", "1", '"partial"', "1", "0", "3", "0", "1", str(len(partial))]
        lines += [f"{numbers[v]} {v + 0.5}" for v in partial] + ["$EndNodeData"]
    return ("\n".join(lines) + "\n").encode()


@st.composite
def cells_and_points(draw, types):
    """Disjoint cells of some of these types, perhaps with lines and triangles on the corners of volumes."""
    kinds = draw(st.lists(st.sampled_from(types), min_size=1, max_size=3, unique=True))
    nodes: list[Any] = []
    cells: list[Any] = []
    for kind in kinds:
        shape, width = kind
        for _ in range(draw(st.integers(1, 3))):
            first = sum(len(of_cell) for of_cell in nodes)
            nodes.append(reference(shape, width) + (2.0 * len(nodes), 0, 0))
            cells.append((shape, list(range(first, first + width))))
    if draw(st.booleans()):
        for shape, row in list(cells):
            if len(CORNERS[shape]) >= 4 and (shape, 3) not in kinds and draw(st.booleans()):
                cells.append(("triangle", row[:3]))
    points = np.concatenate(nodes)
    if draw(st.booleans()):
        shift = draw(st.lists(st.floats(0, 0.125), min_size=6, max_size=6))
        points = points + np.resize(shift, points.shape)
    return points, cells


@st.composite
def meshes(draw, names=plain_names, types=TYPES, finite=False):
    """A mesh of one to three types of cells with up to three arrays and two sets, labels and numbers."""
    numbered = draw(st.booleans())
    fitting = [kind for kind in types if kind in LINEAR and kind[0] in GMSH_TYPES] if numbered else types
    points, cells = draw(cells_and_points(fitting or types))
    if numbered and fitting:
        distinct = [st.lists(st.integers(1, 10**6), min_size=len(of), max_size=len(of), unique=True) for of in (points, cells)]
        partial = draw(st.lists(st.integers(0, len(points) - 1), unique=True, max_size=len(points) - 1))
        mesh = meshorder.read(gmsh_file(points, cells, draw(distinct[0]), draw(distinct[1]), partial), "gmsh")
    else:
        mesh = meshorder.make_mesh(points, [(shape, np.array([row])) for shape, row in cells])
    rows = {True: len(points), False: len(cells)}
    attachments = st.lists(st.tuples(names, st.booleans()), max_size=3, unique=True)
    for name, of_vertices in draw(attachments):
        dtype, components = draw(st.sampled_from(DTYPES)), draw(st.sampled_from([1, 1, 2, 3, 4, 9]))
        if name not in ("partial", "label"):
            mesh._handle.add_data(name, of_vertices, draw(values(rows[of_vertices], dtype, components, finite)))
    for of_vertices in (True, False):
        if draw(st.integers(0, 2)) == 0:
            labels = st.lists(st.integers(-2, 9), min_size=rows[of_vertices], max_size=rows[of_vertices])
            if "label" not in (mesh.point_data if of_vertices else mesh.cell_data):
                mesh._handle.add_data("label", of_vertices, np.array(draw(labels), dtype="i4"))
    for name, of_vertices in draw(st.lists(st.tuples(names, st.booleans()), max_size=2, unique=True)):
        members = st.lists(st.integers(0, rows[of_vertices] - 1), unique=True, max_size=rows[of_vertices])
        mesh._handle.add_set(name, of_vertices, np.array(draw(members), dtype="i4"))
    return mesh
