# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Unstructured grids and surfaces of VTK and of PyVista, whose classes derive from VTK's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._errors import InvalidArgument, Unavailable
from .._meshes import MeshOrder
from .._permutation import Permutation
from .host import Host, Request, moved_rows, parts

_POLYHEDRON = 42
#: VTK's types: pentagonal and hexagonal prisms, quadratic polygons, convex point sets. A grid with such cells is
#: ordered by the vertices of its cells, without their types
_WITHOUT_SHAPE = (15, 16, 36, 41)


class _Dataset(Host):
    """Common base of grids and surfaces."""

    def __init__(self, mesh: Any) -> None:
        self.given = mesh
        points = mesh.GetPoints()
        self.points = np.zeros((0, 3)) if points is None else _array(points.GetData())

    def point_data(self) -> Mapping[str, Any]:
        return _arrays_of(self.given.GetPointData())

    def cell_data(self) -> Mapping[str, Any]:
        return _arrays_of(self.given.GetCellData())

    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        from vtkmodules.vtkCommonCore import vtkPoints

        mesh = self.given
        vertices, cells = order.vertices.permutation, order.cells.permutation
        moved = type(mesh)()
        if mesh.GetPoints() is not None:
            points = vtkPoints()
            points.SetDataType(mesh.GetPoints().GetDataType())
            points.SetData(_support().numpy_to_vtk(vertices.move(self.points), deep=True))
            points.GetData().SetName(mesh.GetPoints().GetData().GetName())
            moved.SetPoints(points)
        self._move_cells(moved, vertices, cells)
        _move_attributes(mesh.GetPointData(), moved.GetPointData(), vertices)
        _move_attributes(mesh.GetCellData(), moved.GetCellData(), cells)
        moved.GetFieldData().ShallowCopy(mesh.GetFieldData())
        if inplace:
            mesh.ShallowCopy(moved)
            mesh.Modified()
            return mesh
        moved.GetInformation().Copy(mesh.GetInformation())
        if hasattr(mesh, "copy_meta_from"):  # a dataset of PyVista
            moved.copy_meta_from(mesh, deep=True)
        return moved

    def _move_cells(self, moved: Any, vertices: Permutation, cells: Permutation) -> None:
        raise NotImplementedError


class Grid(_Dataset):
    """A vtkUnstructuredGrid."""

    def __init__(self, mesh: Any) -> None:
        super().__init__(mesh)
        self._types = _cell_types(mesh)
        offsets, connectivity = _rows(mesh.GetCells())
        shaped = not np.isin(self._types, _WITHOUT_SHAPE).any()
        self.cells = offsets, connectivity, self._types if shaped else None

    def _move_cells(self, moved: Any, vertices: Permutation, cells: Permutation) -> None:
        types = _support().numpy_to_vtk(cells.move(self._types), deep=True)
        rows = _moved_cell_array(self.given.GetCells(), vertices, cells)
        if not (self._types == _POLYHEDRON).any():
            moved.SetCells(types, rows)
            return
        if not hasattr(moved, "SetPolyhedralCells"):
            raise Unavailable("mesh: polyhedra need VTK 9.4 or later")
        # the faces keep their places; each cell's list of faces moves with it
        faces = _moved_cell_array(self.given.GetPolyhedronFaces(), vertices, None)
        faces_of_cells = _moved_cell_array(self.given.GetPolyhedronFaceLocations(), None, cells)
        moved.SetPolyhedralCells(types, rows, faces_of_cells, faces)


class Surface(_Dataset):
    """A vtkPolyData. Its cells are numbered in the order of its four arrays: vertices, lines, polygons, strips."""

    def __init__(self, mesh: Any) -> None:
        super().__init__(mesh)
        parts = [_rows(part) for part in (mesh.GetVerts(), mesh.GetLines(), mesh.GetPolys(), mesh.GetStrips())]
        self._counts = [len(offsets) - 1 for offsets, _ in parts]
        sizes = [np.diff(offsets) for offsets, _ in parts]
        types = [
            np.where(sizes[0] == 1, 1, 2),
            np.where(sizes[1] == 2, 3, 4),
            np.select([sizes[2] == 3, sizes[2] == 4], [5, 9], default=7),
            np.full(self._counts[3], 6),
        ]
        offsets = np.concatenate([[0], np.cumsum(np.concatenate(sizes))])
        self.cells = offsets, np.concatenate([part[1] for part in parts]), np.concatenate(types).astype(np.uint8)

    def order(self, vertices: str, elements: str, options: dict[str, Any]) -> MeshOrder:
        if self._has_polygons_and_strips():
            if options.get("cell_groups") is not None:
                raise InvalidArgument("mesh: cell_groups need a surface without strips; triangulate it first")
            options = {**options, "cell_groups": np.repeat(np.arange(4, dtype=np.int32), self._counts)}
        return super().order(vertices, elements, options)

    def grouped_order(self, request: Request) -> MeshOrder:
        if self._has_polygons_and_strips():
            raise InvalidArgument("mesh: group_by needs a surface without strips; triangulate it first")
        return super().grouped_order(request)

    def _has_polygons_and_strips(self) -> bool:
        """Returns whether an order could mix cells of two arrays: polygons and strips have the same dimension."""
        return self._counts[2] > 0 and self._counts[3] > 0

    def _move_cells(self, moved: Any, vertices: Permutation, cells: Permutation) -> None:
        for name, part in zip(("Verts", "Lines", "Polys", "Strips"), parts(cells, self._counts)):
            if len(part):
                rows = _moved_cell_array(getattr(self.given, f"Get{name}")(), vertices, part)
                getattr(moved, f"Set{name}")(rows)


def _support() -> Any:
    from vtkmodules.util import numpy_support

    return numpy_support


def _array(values: Any) -> NDArray[Any]:
    """Returns the numbers of a VTK array; a view if they are stored row after row."""
    if not values.HasStandardMemoryLayout():
        plain = values.CreateDataArray(values.GetDataType())
        plain.DeepCopy(values)
        values = plain
    numbers: NDArray[Any] = np.asarray(_support().vtk_to_numpy(values))
    return numbers


def _cell_types(grid: Any) -> NDArray[np.uint8]:
    try:
        types = grid.GetCellTypes()  # an array since VTK 9.6
    except TypeError:
        types = grid.GetCellTypesArray()
    return np.zeros(0, dtype=np.uint8) if types is None else _array(types).astype(np.uint8, copy=False)


def _rows(cells: Any) -> tuple[NDArray[Any], NDArray[Any]]:
    """Returns the offsets and connectivity of a vtkCellArray."""
    if cells is None or cells.GetNumberOfCells() == 0:
        return np.zeros(1, dtype=np.int64), np.zeros(0, dtype=np.int64)
    return _array(cells.GetOffsetsArray()), _array(cells.GetConnectivityArray())


def _moved_cell_array(given: Any, vertices: Permutation | None, cells: Permutation | None) -> Any:
    """Returns a vtkCellArray with new vertex numbers, with its rows in a new order, or with both."""
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    offsets, connectivity = _rows(given)
    if cells is not None:
        offsets, connectivity = moved_rows(offsets, connectivity, cells)
    if vertices is not None:
        connectivity = vertices.renumber(connectivity)
    moved = vtkCellArray()
    moved.SetData(_ids(offsets), _ids(connectivity))
    if not given.IsStorage64Bit():
        moved.ConvertTo32BitStorage()
    return moved


def _ids(numbers: NDArray[Any]) -> Any:
    """Returns a vtkIdTypeArray that owns its memory: a vtkCellArray may keep the memory but not the array."""
    return _support().numpy_to_vtkIdTypeArray(np.ascontiguousarray(numbers, dtype=np.int64), deep=True)


def _arrays_of(data: Any) -> dict[str, Any]:
    """Returns the arrays that have a name, as a dict."""
    arrays = (data.GetAbstractArray(number) for number in range(data.GetNumberOfArrays()))
    return {array.GetName(): _values(array) for array in arrays if array.GetName()}


def _values(array: Any) -> NDArray[Any]:
    if array.IsA("vtkDataArray"):
        return _array(array)
    return np.array([array.GetValue(place) for place in range(array.GetNumberOfValues())])  # texts


def _move_attributes(given: Any, moved: Any, permutation: Permutation) -> None:
    """Copies all arrays (numbers, bits and strings) with their names and roles (scalars, normals, global ids)."""
    n = len(permutation)
    if given.GetNumberOfArrays() == 0 or n == 0:
        return
    for number in range(given.GetNumberOfArrays()):
        array = given.GetAbstractArray(number)
        if array.GetNumberOfTuples() != n:
            raise InvalidArgument(f"data '{array.GetName()}': expected {n} rows, not {array.GetNumberOfTuples()}")
    moved.CopyAllOn()
    moved.CopyAllocate(given, n)
    moved.CopyData(given, _id_list(permutation.new_to_old), 0)


def _id_list(numbers: NDArray[Any]) -> Any:
    """Returns a vtkIdList with these numbers, made through a cell because the class accepts no array."""
    from vtkmodules.vtkCommonCore import vtkIdList
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    cell = vtkCellArray()
    cell.SetData(_ids(np.array([0, len(numbers)])), _ids(numbers))
    listed = vtkIdList()
    cell.GetCellAtId(0, listed)
    return listed


def host(mesh: Any) -> Host:
    """Returns the host of a vtkUnstructuredGrid or vtkPolyData."""
    is_a = getattr(mesh, "IsA", None)
    if isinstance(mesh, type) or is_a is None:
        raise InvalidArgument(f"mesh: expected a dataset of VTK or PyVista, not {mesh!r}")
    if is_a("vtkUnstructuredGrid"):
        return Grid(mesh)
    if is_a("vtkPolyData"):
        return Surface(mesh)
    raise InvalidArgument(
        f"mesh: expected a vtkUnstructuredGrid or a vtkPolyData, not a {mesh.GetClassName()}; "
        "other datasets of PyVista have cast_to_unstructured_grid()"
    )
