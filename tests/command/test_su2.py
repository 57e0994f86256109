# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""SU2's meshes, as meshio reads and writes them."""
import re

import meshio
import numpy
import pytest


def cells_of(mesh, kind):
    return numpy.concatenate([block.data for block in mesh.cells if block.type == kind])


def tags_of(mesh, kind, key):
    return numpy.concatenate([tags for block, tags in zip(mesh.cells, mesh.cell_data[key]) if block.type == kind])


def corners(points, cells):
    """Each cell by the coordinates of its nodes, in their order, the cells sorted."""
    return sorted(tuple(map(tuple, points[cell].tolist())) for cell in cells)


def box(n):
    """A cube of wedges and hexahedra with its lower and upper face, by tag."""
    axis = numpy.arange(n + 1)
    z, y, x = numpy.meshgrid(axis, axis, axis, indexing="ij")
    points = numpy.stack([x, y, z], -1).reshape(-1, 3).astype(float)
    at = (x + (n + 1) * (y + (n + 1) * z))
    low = at[:-1, :-1, :-1].ravel()
    right, behind, above = 1, n + 1, (n + 1) ** 2
    quad = numpy.stack([low, low + right, low + right + behind, low + behind], 1)
    half = len(low) // 2
    hexahedra = numpy.concatenate([quad[:half], quad[:half] + above], 1)
    # the first triangle faces outward, as in VTK
    wedges = numpy.concatenate([
        numpy.concatenate([quad[half:][:, pick], quad[half:][:, pick] + above], 1) for pick in ([0, 2, 1], [0, 3, 2])
    ])
    lower = quad[:n * n]
    upper = quad[-n * n:] + above
    triangles = numpy.concatenate([upper[:, [0, 1, 2]], upper[:, [0, 2, 3]]])
    return points, hexahedra, wedges, lower, triangles


def volumes(points, wedges):
    """The volumes of wedges, positive if the first triangle faces outward."""
    corner = points[wedges]
    up = corner[:, 3] - corner[:, 0]
    return -numpy.einsum("ij,ij->i", numpy.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), up) / 2


TYPES = {"triangle": 5, "quad": 9, "hexahedron": 12, "wedge": 13}


def write_su2(path, points, elements, markers):
    def lines(kind, data):
        return "".join(f"{TYPES[kind]} {' '.join(map(str, cell))}\n" for cell in data.tolist())

    # points first: meshio 5.0 misreads files in which they follow many elements
    text = f"NDIME= 3\nNPOIN= {len(points)}\n" + "".join(f"{x} {y} {z}\n" for x, y, z in points.tolist())
    text += f"NELEM= {sum(len(data) for _, data in elements)}\n" + "".join(lines(*block) for block in elements)
    text += f"NMARK= {len(markers)}\n"
    for tag, (kind, data) in markers.items():
        text += f"MARKER_TAG= {tag}\nMARKER_ELEMS= {len(data)}\n" + lines(kind, data)
    path.write_text(text)


def test_a_mesh_is_ordered_and_read_by_meshio(command, tmp_path):
    points, hexahedra, wedges, lower, triangles = box(6)
    shuffle = numpy.random.default_rng(1).permutation(len(points))
    moved = numpy.empty_like(points)
    moved[shuffle] = points
    cells = [("hexahedron", shuffle[hexahedra]), ("wedge", shuffle[wedges]), ("quad", shuffle[lower]),
             ("triangle", shuffle[triangles])]
    write_su2(tmp_path / "a.su2", moved, cells[:2], {3: cells[2], 8: cells[3]})

    command.ok("order", tmp_path / "a.su2", "-o", tmp_path / "b.su2", "--vertices", "rcm", "--elements", "min",
               "--maps", tmp_path / "b")
    before, after = meshio.read(tmp_path / "a.su2"), meshio.read(tmp_path / "b.su2")
    places = numpy.load(tmp_path / "b.vertices.old_to_new.npy")
    assert (after.points[places] == before.points).all()
    for kind, data in cells:
        assert corners(after.points, cells_of(after, kind)) == corners(moved, data)
    assert set(tags_of(after, "quad", "su2:tag")) == {3} and set(tags_of(after, "triangle", "su2:tag")) == {8}
    assert (volumes(after.points, cells_of(after, "wedge")) > 0).all()


def test_wedges_of_other_formats_are_not_turned_inside_out(command, tmp_path):
    points, hexahedra, wedges, _, _ = box(2)
    # in memory meshio's wedges are like Gmsh's: the first triangle faces inward. meshio reverses wedges of .vtu, not of
    # .su2
    inward = wedges[:, [0, 2, 1, 3, 5, 4]]
    meshio.write(tmp_path / "a.vtu", meshio.Mesh(points, [("hexahedron", hexahedra), ("wedge", inward)]))
    command.ok("order", tmp_path / "a.vtu", "-o", tmp_path / "b.su2")
    su2 = meshio.read(tmp_path / "b.su2")
    assert (volumes(su2.points, cells_of(su2, "wedge")) > 0).all()
    command.ok("order", tmp_path / "b.su2", "-o", tmp_path / "c.vtu")
    vtu = meshio.read(tmp_path / "c.vtu")
    assert (volumes(vtu.points, cells_of(vtu, "wedge")) < 0).all()


MSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "inlet"
1 2 "wall"
2 5 "fluid"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
6
1 1 2 1 1 4 1
2 1 2 2 2 1 2
3 1 2 2 3 3 4
4 1 2 1 4 2 3
5 2 2 5 1 1 2 3
6 2 2 5 1 1 3 4
$EndElements
"""


def groups_of_version_2(text):
    """The lines of each named group of a Gmsh file of version 2.2, by coordinates."""
    names = {tag: name.strip('"') for dim, tag, name in rows(text, "PhysicalNames") if dim == "1"}
    points = {tag: tuple(map(float, xyz)) for tag, *xyz in rows(text, "Nodes")}
    found = {}
    for _, kind, _, physical, _, *nodes in rows(text, "Elements"):
        if kind == "1":
            found.setdefault(names[physical], set()).add(frozenset(points[node] for node in nodes))
    return found


def groups_of_version_4(text):
    """The lines of each named group of a Gmsh file of version 4.1, by coordinates."""
    names = {tag: name.strip('"') for dim, tag, name in rows(text, "PhysicalNames") if dim == "1"}
    (n_points, n_curves, *_), *entities = rows(text, "Entities", header=0)
    curves = entities[int(n_points):int(n_points) + int(n_curves)]
    named = {curve[0]: names[curve[8]] for curve in curves if curve[7] == "1"}
    lines = rows(text, "Nodes")
    points = {}
    while lines:
        count = int(lines[0][3])
        for tag, xyz in zip(lines[1:count + 1], lines[count + 1:]):
            points[tag[0]] = tuple(map(float, xyz))
        lines = lines[2 * count + 1:]
    lines = rows(text, "Elements")
    found = {}
    while lines:
        (dim, entity, _, count), *lines = lines
        for _, *nodes in lines[:int(count)] if dim == "1" else []:
            found.setdefault(named[entity], set()).add(frozenset(points[node] for node in nodes))
        lines = lines[int(count):]
    return found


def rows(text, section, header=1):
    """The words of each line of a section, without the line of counts."""
    lines = text.split(f"${section}\n")[1].split(f"$End{section}")[0].splitlines()
    return [line.split() for line in lines[header:]]


def test_groups_of_the_boundary_go_to_su2_and_back(command, tmp_path):
    (tmp_path / "a.msh").write_text(MSH)
    command.ok("order", tmp_path / "a.msh", "-o", tmp_path / "b.su2", "--vertices", "hilbert")
    text = (tmp_path / "b.su2").read_text()
    assert text.startswith("NDIME= 2\n") and "MARKER_TAG= inlet\nMARKER_ELEMS= 2\n" in text
    command.ok("order", tmp_path / "b.su2", "-o", tmp_path / "c.msh", "--vertices", "rcm")
    before = groups_of_version_2(MSH)
    assert set(before) == {"inlet", "wall"}
    assert groups_of_version_4((tmp_path / "c.msh").read_text()) == before


PLATE = """NDIME= 2
NELEM= 2
5 0 1 2
5 1 3 2
NPOIN= 4
0 0
1 0
0 4
1 1
NMARK= 2
MARKER_TAG= {}
MARKER_ELEMS= 1
3 0 1
MARKER_TAG= {}
MARKER_ELEMS= 1
3 1 3
"""


def markers_of(path):
    """The number of elements of each marker."""
    tags = re.findall(r"MARKER_TAG= (.*)\nMARKER_ELEMS= (\d+)", path.read_text())
    return {tag: int(count) for tag, count in tags}


@pytest.mark.parametrize("names", [("inlet", "outlet"), ("7", "9"), ("7", "wall")])
@pytest.mark.parametrize("extension", ["xdmf", "cgns", "msh", "vtu"])
def test_markers_come_back_under_their_names(command, tmp_path, names, extension):
    (tmp_path / "a.su2").write_text(PLATE.format(*names))
    command.ok("order", "a.su2", "-o", f"b.{extension}")
    command.ok("order", f"b.{extension}", "-o", "c.su2")
    assert markers_of(tmp_path / "c.su2") == dict.fromkeys(names, 1)


def test_a_grid_of_xdmf_that_was_added_stays_when_the_file_is_ordered_again(command, tmp_path):
    (tmp_path / "a.su2").write_text(PLATE.format("inlet", "7"))
    command.ok("order", "a.su2", "-o", "b.xdmf")
    command.ok("order", "b.xdmf", "-o", "c.xdmf", "--vertices", "scrambled", "--elements", "scrambled")
    command.ok("order", "c.xdmf", "-o", "d.su2")
    assert markers_of(tmp_path / "d.su2") == {"inlet": 1, "7": 1}


def test_markers_whose_names_are_numbers_are_named_where_they_change(command, tmp_path):
    (tmp_path / "a.su2").write_text(PLATE.format("7", "9"))
    note = "the markers '7', '9' are written as "
    assert note + "labels of their sections, without boundary" in command.fails("order", "a.su2", "-o", "b.cgns", "--strict")
    assert note + "groups named label_N" in command.fails("order", "a.su2", "-o", "b.med", "--strict")
    command.ok("order", "a.su2", "-o", "b.inp")
    deck = (tmp_path / "b.inp").read_text()
    assert "ELSET=label_7" in deck and "ELSET=label_9" in deck and "label_0" not in deck
