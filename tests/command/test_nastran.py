# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Nastran's bulk data, as meshio reads and writes it."""
import itertools

import meshio
import numpy
import pytest

# the corners of each edge; edges in VTK's order of their middle nodes
EDGES = {
    "triangle6": "01 12 02",
    "quad8": "01 12 23 03",
    "tetra10": "01 12 02 03 13 23",
    "hexahedron20": "01 12 23 03 45 56 67 47 04 15 26 37",
}
# Nastran's order where it differs: the edges from bottom to top come before those of the top
NASTRAN = {
    "hexahedron20": "01 12 23 03 04 15 26 37 45 56 67 47",
}
CARDS = {
    "triangle6": "CTRIA6",
    "quad8": "CQUAD8",
    "tetra10": "CTETRA",
    "hexahedron20": "CHEXA",
}
CORNERS = {
    "triangle6": [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
    "quad8": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
    "tetra10": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "hexahedron20": [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))],
}


def edges(kind, order):
    return [tuple(map(int, edge)) for edge in order.get(kind, EDGES[kind]).split()]


def row_of(kind, order, count=5):
    """Points and cells of a row of cells of second order, with the nodes of edges in the given order."""
    number, points, cells = {}, [], []

    def node(point):
        if tuple(point) not in number:
            number[tuple(point)] = len(points)
            points.append(tuple(point))
        return number[tuple(point)]

    for i in range(count):
        corner = numpy.array(CORNERS[kind], float) + (i, 0, 0)
        middle = [(corner[a] + corner[b]) / 2 for a, b in edges(kind, order)]
        cells.append([node(point) for point in (*corner.tolist(), *numpy.array(middle).tolist())])
    return numpy.array(points), numpy.array(cells)


def cells_by_points(points, cells):
    return sorted(tuple(map(tuple, points[cell].tolist())) for cell in cells)


def bulk(points, cards, elements):
    """Bulk data with comma-separated fields, eight per line."""
    lines = [f"GRID,{n},,{','.join(repr(float(x)) for x in point)}" for n, point in enumerate(points, 1)]
    for number, (card, cell) in enumerate(zip(cards, elements), 1):
        fields = [str(number), "3", *(str(node + 1) for node in cell)]
        rows = [",".join(fields[k:k + 8]) for k in range(0, len(fields), 8)]
        lines += [f"{card},{rows[0]}", *("," + row for row in rows[1:])]
    return "BEGIN BULK\n" + "\n".join(lines) + "\nENDDATA\n"


# Debian's meshio has no quadratic wedges and pyramids: tests/io/nastran_test.cpp tests these
@pytest.mark.parametrize("kind", ["triangle6", "quad8", "tetra10", "hexahedron20"])
def test_nodes_of_edges_lie_on_them(command, tmp_path, kind):
    points, cells = row_of(kind, NASTRAN)
    (tmp_path / "a.bdf").write_text(bulk(points, [CARDS[kind]] * len(cells), cells))
    command.ok("order", tmp_path / "a.bdf", "-o", tmp_path / "b.vtu", "--vertices", "rcm", "--elements", "min")
    read = meshio.read(tmp_path / "b.vtu")
    (block,) = read.cells
    assert block.type == kind
    corners = len(CORNERS[kind])
    order = [*range(corners), *(corners + edges(kind, NASTRAN).index(edge) for edge in edges(kind, {}))]
    assert cells_by_points(read.points, block.data) == cells_by_points(points, cells[:, order])
    # and back: the same cells in Nastran's order
    command.ok("order", tmp_path / "b.vtu", "-o", tmp_path / "c.bdf", "--vertices", "original", "--elements", "original")
    command.ok("order", tmp_path / "c.bdf", "-o", tmp_path / "d.vtu", "--vertices", "rcm")
    back = meshio.read(tmp_path / "d.vtu")
    assert cells_by_points(back.points, back.cells[0].data) == cells_by_points(read.points, block.data)
    fields = [line.split() for line in (tmp_path / "c.bdf").read_text().replace("+\n+", " ").splitlines()]
    position = {f[1]: tuple(map(float, f[2:4])) for f in fields if f[0] == "GRID*"}
    heights = [float(f[1]) for f in fields if f[0] == "*"]
    at = {n: numpy.array((*xy, z)) for (n, xy), z in zip(position.items(), heights)}
    for f in fields:
        if f[0] == CARDS[kind]:
            nodes = [at[n] for n in f[3:]]
            for k, (a, b) in enumerate(edges(kind, NASTRAN)):
                assert nodes[corners + k] == pytest.approx((nodes[a] + nodes[b]) / 2)


def lattice(n):
    """A cube of hexahedra whose upper layer is split into wedges, in meshio's node order."""
    number = {p: k for k, p in enumerate(itertools.product(range(n + 1), repeat=3))}
    hexahedra, wedges = [], []
    for x, y, z in itertools.product(range(n), repeat=3):
        low, high = ([number[x + a, y + b, z + c] for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))] for c in (0, 1))
        if z < n - 1:
            hexahedra.append(low + high)
        else:
            wedges += [[low[k] for k in half] + [high[k] for k in half] for half in ((0, 1, 2), (0, 2, 3))]
    return numpy.array(list(number), float) / n, numpy.array(hexahedra), numpy.array(wedges)


@pytest.mark.parametrize("fields", ["free", "fixed-small", "fixed-large"])
@pytest.mark.parametrize("ids", ["renumber", "keep"])
def test_meshio_finds_the_same_mesh(command, tmp_path, fields, ids):
    points, hexahedra, wedges = lattice(4)
    random = numpy.random.default_rng(2)
    new = random.permutation(len(points))
    shuffled = numpy.empty_like(points)
    shuffled[new] = points
    mesh = meshio.Mesh(shuffled, [("hexahedron", new[hexahedra]), ("wedge", new[wedges])],
                       cell_data={"nastran:ref": [numpy.full(len(hexahedra), 4), numpy.arange(len(wedges)) + 20]})
    meshio.nastran.write(tmp_path / "a.nas", mesh, point_format=fields, cell_format="fixed-small")
    command.ok("order", tmp_path / "a.nas", "-o", tmp_path / "b.nas", "--vertices", "rcm", "--elements", "min", "--ids", ids)
    before, after = meshio.read(tmp_path / "a.nas"), meshio.read(tmp_path / "b.nas")
    assert not numpy.array_equal(before.points, after.points)
    assert len((tmp_path / "a.nas").read_text()) == len((tmp_path / "b.nas").read_text())

    def cells(mesh):
        found = []
        for block, refs in zip(mesh.cells, mesh.cell_data["nastran:ref"]):
            for cell, ref in zip(block.data, refs):
                found.append((block.type, int(ref), tuple(map(tuple, mesh.points[cell].tolist()))))
        return sorted(found)

    assert cells(before) == cells(after)
    assert len(cells(after)) == len(hexahedra) + len(wedges)


def test_meshio_reads_what_comes_from_another_format(command, tmp_path):
    points, hexahedra, wedges = lattice(3)
    labels = [numpy.full(len(hexahedra), 4), numpy.arange(len(wedges)) + 20]
    mesh = meshio.Mesh(points * (1 / 3), [("hexahedron", hexahedra), ("wedge", wedges)], cell_data={"label": labels})
    mesh.write(tmp_path / "a.vtu")
    done = command.ok("order", tmp_path / "a.vtu", "-o", tmp_path / "b.bdf", "--vertices", "rcm")
    assert "rounded to the 16 characters of a field of Nastran" in done.stderr
    before, after = meshio.read(tmp_path / "a.vtu"), meshio.read(tmp_path / "b.bdf")
    for kind, data in (("hexahedron", hexahedra), ("wedge", wedges)):
        found = numpy.concatenate([block.data for block in after.cells if block.type == kind])
        sums = [mesh.points[cells].reshape(len(cells), -1) for mesh, cells in ((before, data), (after, found))]
        one, other = (rows[numpy.lexsort(rows.round(6).T)] for rows in sums)
        assert other == pytest.approx(one, abs=1e-13)
    assert sorted(numpy.concatenate(after.cell_data["nastran:ref"])) == sorted(numpy.concatenate(labels))
