# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""AVS UCD, judged by meshio and VTK."""
import meshio
import numpy
import pytest


def cubes(count):
    """A row of cubes with a material for each, a pyramid on the last, and data on points."""
    points = numpy.array([(x, y, z) for x in range(count + 1) for y in (0, 1) for z in (0, 1)] + [(count + 1, .5, .5)])
    corners = numpy.array([0, 4, 6, 2, 1, 5, 7, 3])
    cells = [("hexahedron", corners + 4 * numpy.arange(count)[:, None]),
             ("pyramid", 4 * count + numpy.array([[0, 1, 3, 2, 4]])), ("line", numpy.array([[0, 1]]))]
    materials = [numpy.arange(count), numpy.array([7]), numpy.array([-2])]
    return meshio.Mesh(points, cells, {"temperature": points @ [1., 100, 10], "flow": points * [.5, .25, 2]},
                       {"material": materials})


def by_points(points, cells, materials, values):
    """Each cell by the coordinates of its points, with its material; each point with its values."""
    return (sorted((tuple(map(tuple, points[cell].tolist())), int(m)) for cell, m in zip(cells, materials, strict=True)),
            sorted(map(tuple, numpy.column_stack([points, values]).tolist())))


def by_meshio(path):
    mesh = meshio.read(path, file_format="avsucd")
    cells = [cell for block in mesh.cells for cell in block.data]
    materials = numpy.concatenate(mesh.cell_data["avsucd:material"])
    values = numpy.column_stack([mesh.point_data["temperature"], mesh.point_data["flow"]])
    return by_points(mesh.points, cells, materials, values)


def by_vtk(path):
    geometry = pytest.importorskip("vtkmodules.vtkIOGeometry")
    to_numpy = pytest.importorskip("vtkmodules.util.numpy_support").vtk_to_numpy
    reader = geometry.vtkAVSucdReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    cells = []
    for c in range(grid.GetNumberOfCells()):  # the next call changes what GetCell returned
        ids = grid.GetCell(c).GetPointIds()
        cells.append([ids.GetId(k) for k in range(ids.GetNumberOfIds())])
    values = [to_numpy(grid.GetPointData().GetArray(name)) for name in ("temperature", "flow")]
    return by_points(to_numpy(grid.GetPoints().GetData()), cells,
                     to_numpy(grid.GetCellData().GetArray("Material Id")), numpy.column_stack(values))


@pytest.mark.parametrize("judge", [by_meshio, by_vtk])
def test_others_read_the_same_mesh_in_a_new_order(command, tmp_path, judge):
    cubes(5).write(tmp_path / "a.inp", file_format="avsucd")
    done = command.ok("order", "a.inp", "-o", "b.inp", "--vertices", "scrambled", "--elements", "scrambled", "--strict")
    assert "warning" not in done.stderr and "--ids keep" in done.stdout
    before, after = (tmp_path / "a.inp").read_text(), (tmp_path / "b.inp").read_text()
    assert after.startswith("# Written by meshio") and "flow, real" in after and before != after
    assert judge(tmp_path / "a.inp") == judge(tmp_path / "b.inp")
    kept = command.ok("order", "a.inp", "-o", "c.avs", "--vertices", "scrambled", "--ids", "keep")
    assert "--ids keep" not in kept.stdout and by_meshio(tmp_path / "c.avs") == by_meshio(tmp_path / "a.inp")


def test_its_cells_are_those_of_vtk(command, tmp_path):
    cubes(3).write(tmp_path / "a.inp", file_format="avsucd")
    command.ok("order", "a.inp", "-o", "b.vtu", "--vertices", "original", "--elements", "original")
    mesh = meshio.read(tmp_path / "b.vtu")
    for made, given in zip(mesh.cells, cubes(3).cells, strict=True):
        numpy.testing.assert_array_equal(made.data, given.data)
    command.ok("order", "b.vtu", "-o", "c.avs", "--vertices", "original", "--elements", "original")
    assert by_meshio(tmp_path / "c.avs") == by_meshio(tmp_path / "a.inp")
    command.ok("order", "b.vtu", "-o", "d.inp", "--only", "volume")
    assert (tmp_path / "d.inp").read_text().startswith("*NODE"), "a deck, where the mesh was no UCD"


def test_info_names_the_format_of_the_file(command, tmp_path):
    cubes(2).write(tmp_path / "a.inp", file_format="avsucd")
    assert "\nformat       UCD\n" in command.ok("info", "a.inp").stdout


def test_binary_files_are_named(command, tmp_path):
    (tmp_path / "a.inp").write_bytes(b"\7" + bytes(40))
    assert "a.inp: is a binary AVS UCD file; save it as text" in command.fails("info", "a.inp")
