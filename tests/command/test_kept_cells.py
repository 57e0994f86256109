# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Conversion keeps what the target can hold, and its maps describe the file that is written."""
import meshio
import numpy
import pytest

import meshes

# a unit cube around its centre: twelve triangles, as many tetrahedra, two lines and a point; named groups
CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)] + [(0.5, 0.5, 0.5)]
TRIANGLES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
             (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def cells_in_gmsh(path, dimensions=(0, 1, 2, 3)):
    """Writes the cells of these dimensions, the cells of lower ones first, and returns each as its dimension and vertices."""
    cells = [(0, (0,)), (1, (0, 1)), (1, (1, 3)), *((2, t) for t in TRIANGLES), *((3, (*t[::-1], 8)) for t in TRIANGLES)]
    cells = [(d, vertices) for d, vertices in cells if d in dimensions]
    types = {0: 15, 1: 1, 2: 2, 3: 4}
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "4", '0 1 "anchor"', '1 2 "edge"',
             '2 3 "skin"', '3 4 "body"', "$EndPhysicalNames", "$Nodes", str(len(CORNERS))]
    lines += [f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(CORNERS, 1)]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{i} {types[d]} 2 {d + 1} 1 " + " ".join(str(v + 1) for v in vertices)
              for i, (d, vertices) in enumerate(cells, 1)]
    path.write_text("\n".join([*lines, "$EndElements", ""]))
    return cells


def vega(path):
    """Points and tetrahedra of a Vega file, read word by word."""
    words = path.read_text().split()
    start = words.index("*VERTICES") + 1
    count = int(words[start])
    points = numpy.array(words[start + 4:start + 4 + 4 * count], float).reshape(-1, 4)[:, 1:]
    start = words.index("*ELEMENTS") + 2
    cells = numpy.array(words[start + 3:start + 3 + 5 * int(words[start])], int).reshape(-1, 5)[:, 1:]
    return points, cells - int(words[words.index("*VERTICES") + 5])


def places(points, cells):
    return sorted(sorted(map(tuple, numpy.asarray(points)[list(cell)].tolist())) for cell in cells)


def test_a_gmsh_mesh_with_faces_and_points_becomes_vega_and_its_maps_fit(command, tmp_path):
    cells = cells_in_gmsh(tmp_path / "a.msh")
    done = command.ok("order", "a.msh", "-o", "b.veg", "--maps", "m")
    notes = [line for line in done.stderr.splitlines() if "left out" in line]
    assert [note.split(": ", 1)[1].removeprefix("warning: ") for note in notes] == [
        "1 vertex is left out: Vega cannot hold it", "2 lines are left out: Vega cannot hold them",
        "12 triangles are left out: Vega cannot hold them",
        "the set 'anchor' is left out with all its cells (likewise 'edge', 'skin')"]
    points, tets = vega(tmp_path / "b.veg")
    kept = numpy.load(tmp_path / "m.cells.kept.npy")
    assert kept.tolist() == [i for i, (dimension, _) in enumerate(cells) if dimension == 3]
    vertices = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
    elements = numpy.load(tmp_path / "m.cells.old_to_new.npy")
    assert len(points) == len(CORNERS) and len(tets) == len(kept) == len(elements)
    assert numpy.array_equal(points[vertices], CORNERS)
    for old, new in zip(kept, elements):
        assert tets[new].tolist() == vertices[list(cells[old][1])].tolist()
    # the maps make the same file again, and restore the old order
    command.ok("apply", "m", "a.msh", "-o", "again.veg")
    assert (tmp_path / "again.veg").read_bytes() == (tmp_path / "b.veg").read_bytes()
    command.ok("apply", "m", "b.veg", "-o", "back.veg", "--inverse")
    assert numpy.array_equal(vega(tmp_path / "back.veg")[0], CORNERS)
    assert vega(tmp_path / "back.veg")[1].tolist() == [list(v) for d, v in cells if d == 3]
    # maps of all cells remove the list of kept ones
    command.ok("order", "a.msh", "-o", "b.msh", "--maps", "m")
    assert not (tmp_path / "m.cells.kept.npy").exists()


@pytest.mark.parametrize("extension", [".node", ".mesh"])
def test_a_physical_point_is_left_out(command, tmp_path, extension):
    cells = cells_in_gmsh(tmp_path / "a.msh", (0, 2, 3))
    done = command.ok("order", "a.msh", "-o", f"b{extension}")
    assert "1 vertex is left out" in done.stderr and "triangle" not in done.stderr
    file = tmp_path / f"b{extension}"
    if extension == ".node":
        points, tets = meshes.read_tetgen(file)
    else:
        read = meshio.read(file)
        points, tets = read.points, read.cells_dict["tetra"]
        assert places(points, read.cells_dict["triangle"]) == places(CORNERS, [v for d, v in cells if d == 2])
    assert places(points, tets) == places(CORNERS, [v for d, v in cells if d == 3])


def faces_of(path):
    """Points and triangles of a file with nothing else, by meshio; PLY by its header, as some versions of meshio misread it."""
    if path.suffix != ".ply":
        read = meshio.read(path)
        assert [block.type for block in read.cells] == ["triangle"]
        return read.points, read.cells[0].data
    header, body = path.read_bytes().split(b"end_header\n")
    elements = [line.split()[1:] for line in header.decode().splitlines() if line.startswith("element")]
    assert [name for name, _ in elements] == ["vertex", "face"] and b"binary_little_endian" in header
    vertices, faces = (int(count) for _, count in elements)
    assert header.count(b"property double") == 3 and header.endswith(
        b"property list uchar int vertex_indices\nproperty int label\nproperty int gmsh:geometrical\n")
    points = numpy.frombuffer(body, "<f8", 3 * vertices).reshape(-1, 3)
    rows = numpy.frombuffer(body, [("count", "u1"), ("vertices", "<i4", 3), ("data", "<i4", 2)], faces, 24 * vertices)
    assert set(rows["count"]) == {3} and len(body) == 24 * vertices + 21 * faces
    return points, rows["vertices"]


@pytest.mark.parametrize("extension", [".off", ".ply", ".stl"])
def test_lines_of_a_surface_are_left_out(command, tmp_path, extension):
    cells = cells_in_gmsh(tmp_path / "a.msh", (0, 1, 2))
    done = command.ok("order", "a.msh", "-o", f"b{extension}")
    assert "2 lines are left out" in done.stderr and "1 vertex is left out" in done.stderr
    points, faces = faces_of(tmp_path / f"b{extension}")
    assert places(points, faces) == places(CORNERS, [v for d, v in cells if d == 2])


def test_tetrahedra_are_not_written_where_other_readers_do_not_find_them(command, tmp_path):
    cells_in_gmsh(tmp_path / "a.msh")
    assert command.fails("order", "a.msh", "-o", "b.ply").endswith(
        "b.ply: PLY cannot hold a cell of type tetrahedron; write .msh, .vtu, .vtk, .avs, .vtkhdf, .exo, .xdmf, .cgns or .med")
    assert not (tmp_path / "b.ply").exists()


def test_only_keeps_the_cells_of_one_dimension(command, tmp_path):
    cells = cells_in_gmsh(tmp_path / "a.msh")
    for name, dimension, kind in [("volume", 3, "tetra"), ("surface", 2, "triangle"), ("curve", 1, "line"),
                                  ("point", 0, "vertex")]:
        command.ok("order", "a.msh", "-o", f"{name}.msh", "--only", name)
        read = meshio.read(tmp_path / f"{name}.msh")
        assert {block.type for block in read.cells} == {kind} and len(read.points) == len(CORNERS)
        expected = places(CORNERS, [v for d, v in cells if d == dimension])
        assert places(read.points, [cell for block in read.cells for cell in block.data]) == expected
    command.ok("order", "a.msh", "-o", "skin.off", "--only", "surface", "--maps", "m")
    command.ok("apply", "m", "a.msh", "-o", "again.off", "--only", "surface")
    assert (tmp_path / "again.off").read_bytes() == (tmp_path / "skin.off").read_bytes()
    assert "no curves" in command.fails("order", "surface.msh", "-o", "c.msh", "--only", "curve")
    assert "--only" in command.fails("order", "a.msh", "-o", "c.msh", "--only", "faces")


def test_strict_refuses_what_the_output_cannot_hold(command, tmp_path):
    cells_in_gmsh(tmp_path / "a.msh")
    refusal = command.fails("order", "a.msh", "-o", "b.veg", "--strict")
    assert "Vega cannot hold a cell of type triangle; write .msh, .vtu, .vtk, .avs, .vtkhdf, .exo, .xdmf, .cgns or .med" in refusal
    assert "is not written" in command.fails("order", "a.msh", "-o", "b.mesh", "--strict", "--only", "volume")
    command.ok("order", "a.msh", "-o", "b.msh", "--strict", "--maps", "m")
    assert "Vega cannot hold" in command.fails("apply", "m", "a.msh", "-o", "b.veg", "--strict")
    assert not (tmp_path / "b.veg").exists() and not (tmp_path / "b.mesh").exists()


def test_a_dimension_that_a_mesh_does_not_have_is_named_with_the_file(command, tmp_path):
    cells_in_gmsh(tmp_path / "a.msh", dimensions=(1, 3))
    expected = "a.msh: the mesh has no surfaces; it has 12 tetrahedra, 2 lines"
    assert expected in command.fails("order", "a.msh", "-o", "b.msh", "--only", "surface")
    command.ok("order", "a.msh", "-o", "b.msh", "--maps", "m")
    assert expected in command.fails("apply", "m", "a.msh", "-o", "c.msh", "--only", "surface")
