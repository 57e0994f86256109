# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""PyVista's and VTK's datasets: VTK reads the same from them before and after."""

import importlib.metadata
import subprocess
import sys

import meshorder
import numpy as np
import pytest
from meshorder import InvalidArgument

pv = pytest.importorskip("pyvista")
vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel")

from pyvista.examples import cells as zoo  # noqa: E402
from vtkmodules.util import numpy_support  # noqa: E402

KINDS = (
    "Tetrahedron", "Wedge", "Hexahedron", "Pyramid", "Voxel", "Triangle", "Quadrilateral", "Line", "Vertex", "Polygon",
    "QuadraticTetrahedron", "QuadraticHexahedron", "QuadraticWedge", "QuadraticPyramid", "TriQuadraticHexahedron",
    "LagrangeTetrahedron", "BezierHexahedron",
)  # fmt: skip


def lattice():
    return pv.ImageData(dimensions=(6, 5, 4)).cast_to_unstructured_grid()


def wedges():
    plane = pv.Plane(i_resolution=5, j_resolution=4).triangulate()
    bottom = plane.regular_faces
    n = plane.n_points
    points = np.concatenate([plane.points + [0, 0, z] for z in (0, 0.5, 1)])
    rows = np.concatenate([np.hstack([bottom + z * n, bottom + (z + 1) * n]) for z in range(2)])
    rows[::2] = rows[::2, [0, 2, 1, 3, 5, 4]]  # VTK 9.7 reversed the direction that the first triangle faces
    return pv.UnstructuredGrid({pv.CellType.WEDGE: rows}, points)


def menagerie():
    one = [getattr(zoo, kind)() for kind in KINDS]
    many = [cell.translate((3.0 * i, 0, 2.0 * copy)) for copy in range(3) for i, cell in enumerate(one)]
    return pv.merge(many, merge_points=False)


def polyhedra():
    if not hasattr(vtk.vtkUnstructuredGrid, "SetPolyhedralCells"):
        pytest.skip("VTK before 9.4")
    one = [zoo.Polyhedron(), zoo.Tetrahedron(), zoo.PentagonalPrism(), zoo.HexagonalPrism(), zoo.ConvexPointSet()]
    many = [cell.translate((3.0 * i, 0, 2.0 * copy)) for copy in range(4) for i, cell in enumerate(one)]
    return pv.merge(many, merge_points=False)


def surface():
    return pv.Sphere(theta_resolution=12, phi_resolution=9)


def lines_and_polygons():
    sphere, disc = pv.Sphere(theta_resolution=6, phi_resolution=5), pv.Disc(c_res=6).translate((3, 0, 0))
    line = pv.Line(resolution=4).translate((0, 3, 0))
    points = np.concatenate([sphere.points, disc.points, line.points])
    n, m = sphere.n_points, sphere.n_points + disc.n_points
    mesh = pv.PolyData(points)
    mesh.verts = [1, 2, 1, 0, 2, 4, 5]
    mesh.lines = [line.n_points, *range(m, m + line.n_points), 2, 0, 7]
    strips = sphere.strip()
    quads = disc.faces.reshape(-1, 5)
    mesh.faces = np.concatenate([(quads + [0, n, n, n, n]).ravel(), [5, n, n + 1, n + 2, n + 3, n + 4]])
    mesh.strips = strips.strips
    return mesh


DATASETS = [lattice, wedges, menagerie, polyhedra, surface, lines_and_polygons]


def with_data(mesh):
    mesh.clear_data()
    random = np.random.default_rng(2)
    mesh.point_data["x"] = mesh.points[:, 0].copy()
    mesh.point_data["u"] = random.random((mesh.n_points, 3)).astype(np.float32)
    mesh.point_data["name"] = [f"point {i}" for i in range(mesh.n_points)]
    mesh.point_data["wave"] = random.random(mesh.n_points) + 1j
    mesh.cell_data["flag"] = random.random(mesh.n_cells) < 0.5
    mesh.cell_data["vtkGhostType"] = np.zeros(mesh.n_cells, dtype=np.uint8)
    mesh.cell_data["material"] = random.integers(3, size=mesh.n_cells)
    mesh.GetPointData().GetAbstractArray("u").SetComponentName(1, "sideways")
    mesh.point_data.active_vectors_name = "u"
    mesh.cell_data.active_scalars_name = "material"
    for data, count in ((mesh.GetPointData(), mesh.n_points), (mesh.GetCellData(), mesh.n_cells)):
        ids = numpy_support.numpy_to_vtkIdTypeArray(np.arange(count)[::-1] + 5, deep=True)
        ids.SetName("number")
        data.SetGlobalIds(ids)
    mesh.field_data["time"] = [0.5]
    return mesh


def assert_same_geometry(mesh, moved, order):
    vertices, cells = order.vertices.new_to_old, order.cells.new_to_old
    np.testing.assert_array_equal(moved.points, mesh.points[vertices])
    assert moved.points.dtype == mesh.points.dtype and moved.n_cells == mesh.n_cells
    kinds, moved_kinds = ([m.GetCellType(c) for c in range(m.n_cells)] for m in (mesh, moved))
    np.testing.assert_array_equal(moved_kinds, np.array(kinds)[cells])
    before, after = (m.compute_cell_sizes(length=True, area=True, volume=True) for m in (mesh, moved))
    for size in ("Length", "Area", "Volume"):
        np.testing.assert_allclose(after[size], before[size][cells], atol=1e-12)
    for new in range(mesh.n_cells):
        np.testing.assert_array_equal(vertices[moved.get_cell(new).point_ids], mesh.get_cell(cells[new]).point_ids)


@pytest.mark.parametrize("inplace", [False, True])
@pytest.mark.parametrize("make", DATASETS)
def test_dataset_keeps_its_geometry_and_data(make, inplace):
    given, before = with_data(make()), with_data(make())
    given.find_closest_cell((0, 0, 0))  # this call and the next build caches that the move must discard
    given.point_cell_ids(0)
    moved, order = meshorder.reorder(given, vertices="hilbert", elements="lexmax", inplace=inplace)
    assert (moved is given) == inplace and type(moved) is type(before)
    if not inplace:
        assert given == before
    assert_same_geometry(before, moved, order)
    vertices, cells = order.vertices.new_to_old, order.cells.new_to_old
    for old, new, places in (
        (before.point_data, moved.point_data, vertices),
        (before.cell_data, moved.cell_data, cells),
    ):
        assert list(old) == list(new)
        for name in old:
            np.testing.assert_array_equal(new[name], old[name][places])
            assert new[name].dtype == old[name].dtype
        assert new.active_scalars_name == old.active_scalars_name
        assert new.active_vectors_name == old.active_vectors_name
    for old, new in ((before.GetPointData(), moved.GetPointData()), (before.GetCellData(), moved.GetCellData())):
        assert new.GetGlobalIds().GetName() == old.GetGlobalIds().GetName() == "number"
    assert moved.GetPointData().GetArray("u").GetComponentName(1) == "sideways"
    np.testing.assert_array_equal(moved.field_data["time"], [0.5])
    for point in (0, moved.n_points - 1):
        assert sorted(cells[moved.point_cell_ids(point)]) == sorted(before.point_cell_ids(vertices[point]))
    assert moved.find_closest_point(before.points[3]) in np.flatnonzero((moved.points == before.points[3]).all(axis=1))


def faces(grid, cell):
    return sorted(sorted(map(tuple, face.points)) for face in grid.get_cell(cell).faces)


def test_faces_of_polyhedra_stay_theirs():
    grid = polyhedra()
    moved, order = meshorder.reorder(grid, vertices="scrambled", elements="scrambled")
    found = np.flatnonzero(moved.celltypes == pv.CellType.POLYHEDRON)
    assert len(found) == 4
    for cell in found:
        assert len(faces(moved, cell)) == 4 and faces(moved, cell) == faces(grid, order.cells.new_to_old[cell])


def test_plain_vtk_keeps_its_class():
    for make, kind in ((lattice, vtk.vtkUnstructuredGrid), (surface, vtk.vtkPolyData)):
        plain = kind()
        plain.ShallowCopy(with_data(make()))
        moved, order = meshorder.reorder(plain)
        assert type(moved) is kind
        assert_same_geometry(pv.wrap(plain), pv.wrap(moved), order)


def test_class_of_the_users_own():
    class Part(pv.PolyData):  # type: ignore[misc, name-defined]
        pass

    moved, _ = meshorder.reorder(Part(pv.Sphere()))
    assert type(moved) is Part


def test_order_is_that_of_the_arrays():
    grid = wedges()
    cells = grid.cell_connectivity.reshape(-1, 6)
    by_arrays = meshorder.order_mesh(grid.points, {"wedge": cells}, vertices="fiedler")
    by_grid = meshorder.reorder(grid, vertices="fiedler")[1]
    assert by_grid.vertices.permutation == by_arrays.vertices.permutation
    assert by_grid.cells.permutation == by_arrays.cells.permutation
    assert meshorder.order(grid, "fiedler").permutation == by_arrays.vertices.permutation
    assert meshorder.order_mesh(grid, vertices="fiedler").cells.permutation == by_arrays.cells.permutation


@pytest.mark.parametrize("make", [lattice, menagerie, surface])
@pytest.mark.parametrize("name", ["material", "cells:material"])
def test_groups_of_an_array_stay_together(make, name):
    moved, _ = meshorder.reorder(with_data(make()), group_by=name)
    top = [moved.get_cell(c).dimension for c in range(moved.n_cells)]
    materials = moved.cell_data["material"][np.array(top) == max(top)]
    assert (np.diff(materials) >= 0).all()


def test_groups_that_are_given():
    grid = lattice()
    groups = np.arange(grid.n_cells) % 3
    moved, order = meshorder.reorder(grid, cell_groups=groups)
    assert (np.diff(groups[order.cells.new_to_old]) >= 0).all()


def test_mesh_of_a_grid_reads_the_same_in_vtk(tmp_path):
    for make in (lattice, wedges, surface):
        grid = with_data(make())
        mesh = meshorder.make_mesh(grid)
        assert mesh.notes == ["point data 'name' was left out: it is not made of real numbers"]
        assert meshorder.write(mesh, tmp_path / "grid.vtu") == []
        read = pv.read(tmp_path / "grid.vtu")
        sizes, expected = (m.compute_cell_sizes(length=False) for m in (read, grid))
        np.testing.assert_allclose(np.abs(sizes["Volume"]), np.abs(expected["Volume"]))
        np.testing.assert_allclose(sizes["Area"], expected["Area"])
        np.testing.assert_array_equal(read.cell_data["material"], grid.cell_data["material"])


def test_wedges_of_a_mesh_face_inward():
    mesh = meshorder.make_mesh(wedges())
    corners = mesh.points[mesh.connectivity.reshape(-1, 6)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ij,ij->i", normals, corners[:, 3] - corners[:, 0]) > 0).all()


def test_advice_and_comparison():
    grid = lattice()
    assert len(meshorder.compare(grid, ["rcm"])) == 2 and str(meshorder.advise(grid))
    with pytest.raises(InvalidArgument, match="types of the cells"):
        meshorder.advise(polyhedra())


def test_accessor_is_found_by_its_entry_point():
    if "meshorder" not in importlib.metadata.entry_points(group="pyvista.accessors").names:
        pytest.skip("meshorder is not installed")
    program = "import pyvista; print(type(pyvista.Sphere().meshorder.reorder('hilbert').meshorder.reorder('rcm')))"
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "PolyData" in ended.stdout


def test_accessor():
    import meshorder.pyvista

    for grid in (with_data(lattice()), with_data(surface())):
        moved = grid.meshorder.reorder("rcm", elements="min")
        np.testing.assert_array_equal(moved.points, grid.points[moved["original_point"]])
        np.testing.assert_array_equal(moved.cell_data["material"], grid.cell_data["material"][moved["original_cell"]])
        assert "original_point" not in grid.point_data
        assert grid.meshorder.reorder(inplace=True) is grid and "original_cell" in grid.cell_data
        assert len(grid.meshorder.compare(["rcm"])) == 2 and str(grid.meshorder.advise())


@pytest.mark.parametrize("storage", [32, 64])
def test_width_of_ids_stays(storage):
    grid = lattice()
    cells = vtk.vtkCellArray()
    cells.DeepCopy(grid.GetCells())
    cells.ConvertTo32BitStorage() if storage == 32 else cells.ConvertTo64BitStorage()
    grid.SetCells(numpy_support.numpy_to_vtk(grid.celltypes, deep=True), cells)
    moved, _ = meshorder.reorder(grid)
    assert bool(moved.GetCells().IsStorage64Bit()) == (storage == 64)


def test_fixed_size_storage():
    grid = lattice()
    cells = vtk.vtkCellArray()
    cells.DeepCopy(grid.GetCells())
    if not hasattr(cells, "ConvertToFixedSize64BitStorage"):
        pytest.skip("an older VTK")
    assert cells.ConvertToFixedSize64BitStorage()
    grid.SetCells(numpy_support.numpy_to_vtk(grid.celltypes, deep=True), cells)
    moved, order = meshorder.reorder(grid)
    assert_same_geometry(lattice(), moved, order)


def test_empty_datasets():
    for empty in (pv.UnstructuredGrid(), pv.PolyData(), vtk.vtkUnstructuredGrid(), vtk.vtkPolyData()):
        moved, order = meshorder.reorder(empty)
        assert type(moved) is type(empty) and len(order.vertices.permutation) == 0


def test_points_without_cells():
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(pv.PolyData(np.random.default_rng(3).random((20, 3))).GetPoints())
    moved, order = meshorder.reorder(cloud, vertices="hilbert")
    np.testing.assert_array_equal(pv.wrap(moved).points, pv.wrap(cloud).points[order.vertices.new_to_old])


def nan_points():
    grid = lattice()
    grid.points[3] = np.nan
    return grid


def faulty_connectivity():
    grid = lattice()
    grid.cell_connectivity[0] = 10**6
    return grid


def faulty_data():
    plain = vtk.vtkUnstructuredGrid()
    plain.ShallowCopy(lattice())
    plain.GetPointData().AddArray(pv.convert_array(np.arange(3.0), name="short"))
    return plain


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: pv.ImageData(dimensions=(3, 3, 3)), lambda: pv.MultiBlock([pv.Sphere()]), lambda: pv.UnstructuredGrid,
        lambda: pv.StructuredGrid(), lambda: pv.PointSet([[0.0, 0, 0]]), lambda: vtk.vtkImageData(), nan_points,
        faulty_connectivity, faulty_data, lambda: pv.UnstructuredGrid([0], [0], np.zeros((1, 3))),
    ],
)  # fmt: skip
def test_refuses(wrong):
    with pytest.raises(InvalidArgument):
        meshorder.reorder(wrong())


def test_refuses_options_that_do_not_apply():
    with pytest.raises(InvalidArgument, match="meshorder.Mesh only"):
        meshorder.reorder(lattice(), ids="keep")
    with pytest.raises(InvalidArgument, match="colour"):
        meshorder.reorder(lattice(), group_by="colour")
    with pytest.raises(InvalidArgument, match="strips"):
        meshorder.reorder(with_data(lines_and_polygons()), group_by="material")
    with pytest.raises(InvalidArgument, match="strips"):
        meshorder.reorder(lines_and_polygons(), cell_groups=np.zeros(lines_and_polygons().n_cells, dtype=int))
