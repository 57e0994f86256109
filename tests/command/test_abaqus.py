# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Decks of Abaqus and CalculiX, judged by CalculiX, meshio and Gmsh."""
import itertools
import re
import shutil
import subprocess

import meshio
import numpy
import pytest

needs_calculix = pytest.mark.skipif(shutil.which("ccx") is None, reason="needs CalculiX (Debian: calculix-ccx)")

TETRAHEDRA = ((0, 1, 3, 7), (0, 1, 7, 4), (4, 1, 7, 5), (1, 2, 3, 7), (1, 2, 7, 6), (1, 6, 7, 5))
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))


def bar(kind, size=(6, 2, 2)):
    """The nodes and the elements of a bar: corners have even lattice coordinates, mid-nodes odd ones."""
    nodes, elements = {}, []

    def number(point):
        return nodes.setdefault(tuple(int(x) for x in point), len(nodes) + 1)

    for i, j, k in itertools.product(*map(range, size)):
        corners = numpy.array([(2 * (i + a), 2 * (j + b), 2 * (k + c))
                               for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))])
        for cell in [range(8)] if kind == "C3D8" else TETRAHEDRA:
            points = list(corners[list(cell)])
            if len(points) == 4 and numpy.linalg.det(numpy.array(points[1:]) - points[0]) < 0:
                points[1], points[2] = points[2], points[1]
            if kind == "C3D10":
                points += [(points[a] + points[b]) // 2 for a, b in EDGES]
            elements.append([number(point) for point in points])
    return nodes, elements


def cantilever(kind):
    """A deck with random numbering and each kind of reference to the numbers, and the cantilever's length."""
    nodes, elements = bar(kind)
    random = numpy.random.default_rng(5)
    new = random.permutation(len(nodes)) + 1
    of_number = {int(new[old - 1]): point for point, old in nodes.items()}
    elements = [[int(new[node - 1]) for node in elements[k]] for k in random.permutation(len(elements))]
    length = max(point[0] for point in nodes)
    fixed = sorted(n for n, point in of_number.items() if point[0] == 0)
    tip = sorted(n for n, point in of_number.items() if point[0] == length)
    lines = ["*Heading", f" a bar of {len(nodes)} nodes, 1", "** made for a test", "*NODE, NSET=Nall"]
    lines += [f"{n:6d}, {x / 20:.6f}, {y / 20:.6f}, {z / 20:.6f}" for n, (x, y, z) in sorted(of_number.items())]
    lines += [f"*Element, type={kind}, elset=Eall"]
    lines += [f"{e}, {', '.join(map(str, cell))}" for e, cell in enumerate(elements, 1)]
    lines += ["*NSET, NSET=fixed"] + [", ".join(map(str, fixed[k:k + 7])) + "," for k in range(0, len(fixed), 7)]
    half = len(elements) // 2
    lines += ["*Elset, elset=half, generate", f"1, {half}, 1", "*NSET, NSET=watched", "fixed,", f"{tip[0]}, {tip[1]}"]
    lines += ["*SURFACE, NAME=pressed, TYPE=ELEMENT"] + [f"{e}, S2" for e in range(3, 9)]
    lines += ["*MATERIAL, NAME=steel", "*ELASTIC", "210000, 0.3", "*SOLID SECTION, ELSET=Eall, MATERIAL=steel"]
    lines += ["*EQUATION", "2", f"{tip[0]}, 1, 1., {tip[1]}, 1, -1."]
    lines += ["*STEP", "*STATIC", "*BOUNDARY", "FIXED, 1, 3", f"{tip[2]}, 2, 2, 0.001"]
    lines += ["*CLOAD", f"{tip[-1]}, 3, -10.", "*DLOAD", "half, P1, 0.5", f"{len(elements)}, P3, 1.5"]
    lines += ["*DSLOAD", "pressed, P, 0.3", "*NODE PRINT, NSET=Nall", "U", "*EL PRINT, ELSET=half, TOTALS=ONLY", "ELSE",
              "*NODE PRINT, NSET=watched, TOTALS=ONLY", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


def solved(folder, name):
    """What CalculiX prints: the displacements of each node, and all other lines of numbers."""
    done = subprocess.run(["ccx", name], cwd=folder, capture_output=True, text=True, timeout=300, check=False)
    assert "ERROR" not in done.stdout, done.stdout
    displacements, others, in_displacements = {}, [], False
    for line in (folder / f"{name}.dat").read_text().splitlines():
        if line.strip().startswith(("displacements", "total", "internal")):
            in_displacements = line.strip().startswith("displacements")
            continue
        words = line.split()
        if in_displacements and len(words) == 4:
            displacements[int(words[0])] = [float(word) for word in words[1:]]
        elif words:
            others.append([float(word) for word in words if re.fullmatch(r"-?[\d.]+E?[+-]?\d*", word)])
    return displacements, others


@needs_calculix
@pytest.mark.parametrize("kind", ["C3D4", "C3D8", "C3D10"])
@pytest.mark.parametrize("ids", ["renumber", "keep"])
def test_calculix_finds_the_same_displacements(command, tmp_path, kind, ids):
    (tmp_path / "a.inp").write_text(cantilever(kind))
    command.ok("order", tmp_path / "a.inp", "-o", tmp_path / "b.inp", "--vertices", "rcm", "--elements", "min",
               "--ids", ids, "--maps", tmp_path / "maps")
    before, totals = solved(tmp_path, "a")
    after, new_totals = solved(tmp_path, "b")
    assert len(before) == len(after) > 50
    new = numpy.load(tmp_path / "maps.vertices.old_to_new.npy") + 1 if ids == "renumber" else None
    for number, displacement in before.items():
        same = after[int(new[number - 1]) if new is not None else number]
        assert displacement == pytest.approx(same, rel=1e-5, abs=1e-9)
    assert max(abs(x) for u in before.values() for x in u) > 1e-3
    for one, other in zip(totals, new_totals, strict=True):
        assert one == pytest.approx(other, rel=1e-4, abs=1e-6)
    # node by node the values differ: the nodes have moved
    assert (new is None) or any(before[n] != pytest.approx(after[n], rel=1e-3) for n in before)


@needs_calculix
def test_a_comma_at_the_end_of_a_keyword_line_is_followed_by_data(command, tmp_path):
    deck = cantilever("C3D8")
    for keyword in ("*NODE, NSET=Nall", "elset=Eall", "*NSET, NSET=fixed", "half, generate", "TYPE=ELEMENT", "*EQUATION",
                    "*BOUNDARY", "*CLOAD", "*DLOAD", "*DSLOAD"):
        assert keyword + "\n" in deck
        deck = deck.replace(keyword + "\n", keyword + ", \n")
    (tmp_path / "a.inp").write_text(deck)
    (tmp_path / "plain.inp").write_text(cantilever("C3D8"))
    command.ok("order", tmp_path / "a.inp", "-o", tmp_path / "b.inp", "--vertices", "scrambled", "--maps", tmp_path / "m")
    before, after = solved(tmp_path, "a")[0], solved(tmp_path, "b")[0]
    assert before == solved(tmp_path, "plain")[0]
    new = numpy.load(tmp_path / "m.vertices.old_to_new.npy") + 1
    for number, displacement in before.items():
        assert displacement == pytest.approx(after[int(new[number - 1])], rel=1e-5, abs=1e-9)


def test_the_rest_of_a_deck_stays(command, tmp_path):
    deck = cantilever("C3D4")
    (tmp_path / "a.inp").write_text(deck)
    command.ok("order", tmp_path / "a.inp", "-o", tmp_path / "b.inp", "--vertices", "rcm", "--ids", "keep")
    after = (tmp_path / "b.inp").read_text()
    rest = deck[deck.index("*NSET, NSET=fixed"):]
    assert after.endswith(rest) and after.startswith(deck[:deck.index("     1, ")])
    mesh_of = {name: meshio.read(tmp_path / name) for name in ("a.inp", "b.inp")}
    assert not numpy.array_equal(mesh_of["a.inp"].points, mesh_of["b.inp"].points)
    # back again: all is restored except the range, which stays a list
    command.ok("order", tmp_path / "a.inp", "-o", tmp_path / "same.inp", "--vertices", "original", "--elements",
               "original")
    command.ok("order", tmp_path / "a.inp", "-o", tmp_path / "c.inp", "--vertices", "rcm", "--maps", tmp_path / "p")
    command.ok("apply", tmp_path / "p", tmp_path / "c.inp", "--inverse", "-o", tmp_path / "d.inp")
    same, back = (tmp_path / "same.inp").read_text(), (tmp_path / "d.inp").read_text()
    half = same[same.index("*Elset, elset=half"):same.index("*NSET, NSET=watched")]
    parts = same.split(half)
    assert back.startswith(parts[0] + "*Elset, elset=half\n") and back.endswith(parts[1])


def shape_of(mesh):
    """The cells of each type by the coordinates of their nodes, in their order."""
    result = {}
    for block in mesh.cells:
        result.setdefault(block.type, []).extend(tuple(map(tuple, mesh.points[cell].tolist())) for cell in block.data)
    return {kind: sorted(cells) for kind, cells in result.items()}


def set_of_cells(mesh, name):
    return sorted(tuple(map(tuple, mesh.points[mesh.cells[b].data[c]].tolist()))
                  for b, members in enumerate(mesh.cell_sets[name]) if members is not None for c in members)


def set_of_points(mesh, name):
    return sorted(map(tuple, mesh.points[numpy.asarray(mesh.point_sets[name], dtype=int)].tolist()))


def test_meshio_reads_the_same_mesh(command, tmp_path):
    nodes, elements = bar("C3D8")
    points = numpy.array(list(nodes), dtype=float) / 8
    tetrahedra = numpy.array(bar("C3D4")[1]) - 1
    hexahedra = numpy.array(elements) - 1
    mesh = meshio.Mesh(points, [("hexahedron", hexahedra[:10]), ("tetra", tetrahedra[60:])],
                       point_sets={"left": numpy.arange(7)},
                       cell_sets={"some": [numpy.array([1, 5]), numpy.array([0, 2, 9])]})
    mesh.write(tmp_path / "a.inp", float_fmt=".10e")
    command.ok("order", tmp_path / "a.inp", "-o", tmp_path / "b.inp", "--vertices", "scrambled", "--elements",
               "scrambled")
    before, after = meshio.read(tmp_path / "a.inp"), meshio.read(tmp_path / "b.inp")
    assert shape_of(before) == shape_of(after)
    assert set_of_points(before, "left") == set_of_points(after, "left")
    some = [numpy.concatenate([block.data[m].ravel() for block, m in zip(read.cells, read.cell_sets["some"]) if len(m)])
            for read in (before, after)]
    assert sorted(map(tuple, before.points[some[0]].tolist())) == sorted(map(tuple, after.points[some[1]].tolist()))
    assert not numpy.array_equal(before.points, after.points)

    # a deck written from a mesh of another format has the same cells
    command.ok("order", tmp_path / "a.inp", "-o", tmp_path / "c.vtu")
    command.ok("order", tmp_path / "c.vtu", "-o", tmp_path / "d.inp", "--vertices", "hilbert")
    assert shape_of(meshio.read(tmp_path / "d.inp")) == shape_of(before)


def test_gmsh_and_this_writer_agree_on_the_order_of_nodes(command, tmp_path):
    gmsh = pytest.importorskip("gmsh")
    kinds = {1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 11: 10, 16: 8, 17: 20, 18: 15}
    random = numpy.random.default_rng(1)
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        volume = gmsh.model.addDiscreteEntity(3)
        gmsh.model.mesh.addNodes(3, volume, list(range(1, 31)), numpy.round(random.random(90), 6).tolist())
        tag = 1
        for kind in kinds:
            _, dimension, _, count, _, _ = gmsh.model.mesh.getElementProperties(kind)
            entity = gmsh.model.addDiscreteEntity(dimension)
            gmsh.model.mesh.addElementsByType(entity, kind, [tag], list(range(1, count + 1)))
            tag += 1
        for name in ("a.msh", "a.inp"):
            gmsh.write(str(tmp_path / name))
    finally:
        gmsh.finalize()
    # the mesh read from Gmsh's deck is Gmsh's mesh, and the deck written from that mesh has the lines of Gmsh's deck
    command.ok("order", "a.inp", "-o", "b.msh", "--vertices", "original", "--elements", "original", "--ids", "keep")
    command.ok("order", "a.msh", "-o", "c.inp", "--vertices", "original", "--elements", "original", "--ids", "keep")

    def elements(name):
        lines = (tmp_path / name).read_text().replace(", \n", ", ").replace(",\n", ", ").splitlines()
        return sorted(tuple(map(int, line.split(","))) for line in lines if re.fullmatch(r"\d+(, ?\d+)+", line))

    assert elements("a.inp") == elements("c.inp") and len(elements("a.inp")) == len(kinds)
    command.ok("order", "b.msh", "-o", "d.inp", "--vertices", "original", "--elements", "original", "--ids", "keep")
    assert elements("a.inp") == elements("d.inp")


def test_a_card_that_is_not_understood_keeps_numbers(command, tmp_path):
    deck = cantilever("C3D4").replace("*STEP\n", "*FIELD LOAD\n12, 1\n*STEP\n")
    (tmp_path / "a.inp").write_text(deck)
    done = command.ok("order", "a.inp", "-o", "b.inp", "--vertices", "rcm")
    assert done.stderr.count("keep their numbers") == 1 and "*FIELD LOAD (line " in done.stderr
    after = (tmp_path / "b.inp").read_text()
    assert after.endswith(deck[deck.index("*NSET, NSET=fixed"):])
    line = command.fails("order", "a.inp", "-o", "c.inp", "--vertices", "rcm", "--ids", "attach")
    assert "--ids keep" in line and not (tmp_path / "c.inp").exists()


def test_what_another_format_loses_is_named(command, tmp_path):
    (tmp_path / "a.inp").write_text(cantilever("C3D4"))
    done = command.ok("order", "a.inp", "-o", "b.vtu")
    assert "surfaces of the deck: 'pressed'" in done.stderr and "*MATERIAL" in done.stderr
    command.ok("order", "b.vtu", "-o", "c.inp")
    text = (tmp_path / "c.inp").read_text()
    assert "*ELSET, ELSET=Eall" in text and "*NSET, NSET=fixed" in text


def test_an_included_file_elsewhere_is_refused(command, tmp_path):
    (tmp_path / "deck").mkdir()
    (tmp_path / "nodes.inp").write_text("1, 0, 0, 0\n")
    (tmp_path / "deck" / "a.inp").write_text("*NODE, INPUT=../nodes.inp\n")
    line = command.fails("order", "deck/a.inp", "-o", "b.inp")
    assert "deck/a.inp:1: the included file '../nodes.inp' is not in the deck's folder" in line
