# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Conversion of cells of every linear and second-order type from each format to each other.

A cell is an affine image of its reference element. Gmsh, VTK and meshio read the written files. The node order is checked
against each library's own reference element, or against the nodes of its edges and faces.
"""

from typing import Any

import meshio
import meshorder
import numpy as np
import pytest

gmsh = pytest.importorskip("gmsh")
pytest.importorskip("vtk")
from vtkmodules.vtkIOCGNSReader import vtkCGNSReader
from vtkmodules.vtkIOExodus import vtkExodusIIReader  # noqa: E402
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader  # noqa: E402
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader  # noqa: E402

# Gmsh's number of each cell type, by meshio's name
TYPES = {
    "line": 1, "triangle": 2, "quad": 3, "tetra": 4, "hexahedron": 5, "wedge": 6, "pyramid": 7,
    "line3": 8, "triangle6": 9, "quad9": 10, "tetra10": 11, "hexahedron27": 12, "wedge18": 13,
    "quad8": 16, "hexahedron20": 17, "wedge15": 18, "pyramid13": 19,
}  # fmt: skip
UNKNOWN_TO_MESHIO = {"wedge15", "pyramid13"}  # version 5.3.5 stops at them
FORMATS = [".msh", ".vtk", ".vtu", ".mesh", ".su2", ".unv", ".bdf"] + [
    suffix
    for suffix, library in ((".inp", ""), (".exo", "netcdf"), (".xdmf", "hdf5"), (".med", "hdf5"), (".cgns", "cgns"))
    if library in meshorder.build_info()
]
IMAGE = np.array([[2.0, 0.3, 0.1], [-0.2, 1.5, 0.4], [0.25, -0.1, 1.8]])
ORIGIN = np.array([0.5, -1.0, 2.0])


def reference(kind):
    """The nodes of Gmsh's reference element: count × dimension."""
    _, dimension, _, count, places, _ = gmsh.model.mesh.getElementProperties(kind)
    return np.array(places).reshape(count, -1)[:, :dimension]


def write_by_gmsh(kind, path):
    places = reference(kind)
    count, dimension = places.shape
    points = places @ IMAGE[:dimension] + ORIGIN
    gmsh.model.add("cell")
    gmsh.model.addDiscreteEntity(dimension, 1)
    gmsh.model.mesh.addNodes(dimension, 1, range(1, count + 1), points.ravel())
    gmsh.model.mesh.addElementsByType(1, kind, [1], range(1, count + 1))
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    gmsh.write(str(path))


def assert_right_by_gmsh(kind, path):
    gmsh.clear()
    gmsh.open(str(path))
    found, tags, ends = gmsh.model.mesh.getElements()
    assert list(found) == [kind] and len(tags[0]) == 1
    places = reference(kind)
    points = np.array([gmsh.model.mesh.getNode(end)[0] for end in ends[0]])
    fit, *_ = np.linalg.lstsq(np.c_[places, np.ones(len(places))], points, rcond=None)
    assert np.allclose(fit[:-1], IMAGE[: places.shape[1]], atol=1e-6)


def points_of(cell):
    return np.array([cell.GetPoints().GetPoint(k) for k in range(cell.GetNumberOfPoints())])


def grid_by_vtk(path):
    readers = {
        ".vtu": vtkXMLUnstructuredGridReader, ".vtk": vtkUnstructuredGridReader,
        ".exo": vtkExodusIIReader, ".cgns": vtkCGNSReader,
    }  # fmt: skip
    reader: Any = readers[path.suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    while not hasattr(grid, "GetNumberOfCells") or hasattr(grid, "GetNumberOfBlocks"):
        grid = grid.GetBlock(0)
    return grid


def assert_right_by_vtk(kind, path):
    grid = grid_by_vtk(path)
    assert grid.GetNumberOfCells() == 1
    cell = grid.GetCell(0)
    points = points_of(cell)
    assert len(points) == len(reference(kind))
    for edge in map(cell.GetEdge, range(cell.GetNumberOfEdges())):
        first, second, *middle = points_of(edge)
        assert all(np.allclose(node, (first + second) / 2, atol=1e-6) for node in middle)
    # VTK 9.7 reversed its linear wedges; our .vtu and .vtk files have the order of earlier versions
    sign = -1 if TYPES["wedge"] == kind and path.suffix in (".vtu", ".vtk") else 1
    for face in map(cell.GetFace, range(cell.GetNumberOfFaces())):
        corners = points_of(face)[: face.GetNumberOfEdges()]
        outward = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        assert sign * (outward @ (corners.mean(0) - points.mean(0))) > 0
    if cell.GetCellDimension() == 2:
        assert np.cross(points[1] - points[0], points[2] - points[0]) @ np.cross(IMAGE[0], IMAGE[1]) > 0


def assert_right_by_meshio(kind, path):
    """Asserts that the corners give a positive volume. meshio keeps the file's order of linear wedges."""
    [block] = meshio.read(path).cells
    assert TYPES[block.type] == kind
    points = meshio.read(path).points[block.data[0]]
    dimension = reference(kind).shape[1]
    edges = points[[1, 2 if dimension == 2 or "tet" in block.type or "wedge" in block.type else 3,
                    3 if "tet" in block.type or "wedge" in block.type else 4][:dimension]] - points[0]  # fmt: skip
    spanned = edges @ np.linalg.pinv(IMAGE[:dimension])
    assert np.linalg.det(spanned) > 0


def meshio_reads(name, target):
    linear = not any(letter.isdigit() for letter in name)
    turned = name == "wedge" and target in (".vtk", ".su2", ".xdmf")  # first triangle outward, as in VTK up to 9.6
    if (name, target) == ("pyramid", ".inp"):  # a type that meshio does not know in decks
        return False
    return name not in UNKNOWN_TO_MESHIO and not turned and (
        target == ".vtk" or linear and target in (".mesh", ".su2", ".inp", ".xdmf")
    )


@pytest.mark.parametrize("name", TYPES)
@pytest.mark.parametrize("source", FORMATS)
def test_faces_and_nodes_of_edges_stay_right(model, tmp_path, name, source):
    kind = TYPES[name]
    write_by_gmsh(kind, tmp_path / "cell.msh")
    mesh = meshorder.read(tmp_path / "cell.msh")
    try:
        meshorder.write(mesh, tmp_path / f"from{source}")
        mesh = meshorder.read(tmp_path / f"from{source}")
    except meshorder.InputError as error:
        pytest.skip(str(error))
    judged = 0
    for target in FORMATS:
        path = tmp_path / f"to{target}"
        try:
            meshorder.write(mesh, path)
        except meshorder.InputError:
            continue
        # Gmsh 4.15 reads only the corners of second-order pyramids in Nastran's files, and no such pyramids in CGNS
        of_gmsh = (".msh", ".unv", ".med") + ((".bdf", ".cgns") if name != "pyramid13" else ())
        if target in of_gmsh:
            assert_right_by_gmsh(kind, path)
        if target in (".vtu", ".vtk", ".exo", ".cgns"):
            assert_right_by_vtk(kind, path)
        if meshio_reads(name, target):
            assert_right_by_meshio(kind, path)
        judged += 1
    assert judged >= 3


@pytest.mark.parametrize("name", [name for name in TYPES if name not in UNKNOWN_TO_MESHIO])
def test_cells_of_meshio_are_taken_in_its_order(model, tmp_path, name):
    """meshio's VTK file and Gmsh's own file of the same cell give the same mesh."""
    kind = TYPES[name]
    write_by_gmsh(kind, tmp_path / "cell.msh")
    by_gmsh = meshio.read(tmp_path / "cell.msh")
    if name == "wedge18":
        pytest.skip("meshio 5.3.5 does not put the nodes of Gmsh's wedge18 in its own order")
    by_gmsh.cell_data, by_gmsh.cell_sets, by_gmsh.point_data = {}, {}, {}
    by_gmsh.write(tmp_path / "meshio.vtu")
    meshorder.write(meshorder.read(tmp_path / "meshio.vtu"), tmp_path / "back.msh")
    assert_right_by_gmsh(kind, tmp_path / "back.msh")
