# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The interface of other libraries' meshes for the functions on meshes."""

from __future__ import annotations

import abc
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._arrays import integers
from .._arrays import points as as_points
from .._errors import InvalidArgument
from .._meshes import Mesh, MeshOrder, cell_arrays, order_arrays
from .._options import prepared
from .._permutation import Permutation

_VTK_WEDGE = 13


@dataclass(frozen=True)
class Request:
    """The arguments of `meshorder.reorder`, apart from the mesh."""

    vertices: str = "auto"
    elements: str = "auto"
    group_by: str | None = None
    ids: str = "renumber"
    format: str | None = None
    inplace: bool = False
    options: dict[str, Any] = field(default_factory=dict)


class Host(abc.ABC):
    """A mesh of another library, in the form that the functions on meshes use.

    Attributes:
        given: the mesh itself.
        points: one row of one to three coordinates for each vertex.
        cells: the cells, in one of the forms that `meshorder.order_mesh` takes.
        takes_weights: whether `meshorder.order` accepts points and weights with it, as for a graph.
    """

    takes_weights = False

    given: Any
    points: Any
    cells: Any

    @abc.abstractmethod
    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        """Returns the mesh with vertices, cells and their data in another order: a new mesh, or ``given`` changed."""

    def point_data(self) -> Mapping[str, Any]:
        """Returns the arrays with a row for each vertex, by name."""
        return {}

    def cell_data(self) -> Mapping[str, Any]:
        """Returns the arrays with a row for each cell, by name."""
        return {}

    def point_sets(self) -> Mapping[str, Any]:
        """Returns the sets of vertices by name: arrays of vertex numbers."""
        return {}

    def cell_sets(self) -> Mapping[str, Any]:
        """Returns the sets of cells by name: arrays of cell numbers."""
        return {}

    def graph(self, mirror: bool) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]] | None:
        """Returns the offsets and neighbours of a graph, and the place of each entry in the input; None for meshes.

        Args:
            mirror: True: directed edges are taken in both directions.
        """
        return None

    def order(self, vertices: str, elements: str, options: dict[str, Any]) -> MeshOrder:
        """Finds new places for the vertices and cells; see `meshorder.order_mesh`."""
        return order_arrays(self.points, self.cells, vertices, elements, None, options)

    def reorder(self, request: Request) -> tuple[Any, MeshOrder]:
        """Returns the mesh in a new order, and its orders; see `meshorder.reorder`."""
        if request.ids != "renumber" or request.format:
            raise InvalidArgument("reorder: ids and format can be given for a meshorder.Mesh only")
        if request.group_by:
            order = self.grouped_order(request)
        else:
            order = self.order(request.vertices, request.elements, request.options)
        return self.moved(order, request.inplace), order

    def grouped_order(self, request: Request) -> MeshOrder:
        """Finds the order that keeps the groups of an array together, using a `meshorder.Mesh` with the same arrays."""
        handle = self.mesh()._handle
        with prepared(request.options) as given:
            return MeshOrder._of(
                handle.reorder(request.vertices, request.elements, "renumber", request.group_by or "", "", given)
            )

    def mesh(self) -> Mesh:
        """Returns a `meshorder.Mesh` with the same data and sets; its notes name the data that it cannot hold."""
        coordinates = as_points(self.points)
        cells = wedges_inward(coordinates, cell_arrays(self.cells, coordinates.shape[1]))
        made = Mesh(_core.make_mesh(coordinates, cells))
        for of_vertices, arrays in ((True, self.point_data()), (False, self.cell_data())):
            for name, values in arrays.items():
                numbers = _numbers(values)
                if numbers is None:
                    owner = "point" if of_vertices else "cell"
                    made.notes.append(f"{owner} data '{name}' was left out: it is not made of real numbers")
                else:
                    made._handle.add_data(str(name), of_vertices, numbers)
        for of_vertices, sets in ((True, self.point_sets()), (False, self.cell_sets())):
            for name, members in sets.items():
                found = integers(members, f"set '{name}'")
                _, first = np.unique(found, return_index=True)
                made._handle.add_set(str(name), of_vertices, np.ascontiguousarray(found[np.sort(first)]))
        made._handle.check()
        return made


def parts(cells: Permutation, sizes: Sequence[int]) -> list[Permutation]:
    """Returns the permutation of the cells of each block, for cells that stay in their block.

    Args:
        cells: permutation of all cells, which are numbered block after block.
        sizes: number of cells of each block.
    """
    if len(sizes) == 1:
        return [cells]
    ends = np.cumsum(sizes, dtype=np.int64)
    return [
        Permutation(new_to_old=cells.new_to_old[end - size : end] - np.int32(end - size))
        for size, end in zip(sizes, ends)
    ]


def moved_data(permutation: Permutation, values: Any, name: str) -> Any:
    """Returns the moved rows of an array of data.

    Raises:
        InvalidArgument: the array has another number of rows.
    """
    array = np.asanyarray(values)
    if array.ndim == 0 or len(array) != len(permutation):
        raise InvalidArgument(f"data '{name}': expected {len(permutation)} rows, not the shape {array.shape}")
    return permutation.move(array)


def moved_rows(
    offsets: NDArray[Any], entries: NDArray[Any], rows: Permutation
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Returns the offsets and entries of rows of any length in their new order; both are new arrays."""
    widths = np.diff(offsets)
    if len(widths) and (widths == widths[0]).all():
        return offsets.copy(), rows.move(entries.reshape(len(widths), -1)).reshape(-1)
    sizes = widths[rows.new_to_old]
    new_offsets = np.zeros_like(offsets)
    np.cumsum(sizes, out=new_offsets[1:])
    places = np.repeat(offsets[:-1][rows.new_to_old] - new_offsets[:-1], sizes)
    places += np.arange(len(places), dtype=places.dtype)
    return new_offsets, entries[places]


def _numbers(values: Any) -> NDArray[Any] | None:
    """Returns values as an array of real numbers of rank 1 or 2, with NaN for masked ones; None for other types."""
    if np.ma.is_masked(values):
        values = np.ma.filled(values.astype(np.float64), np.nan)
    array = np.asarray(values)
    if array.dtype.kind == "b":
        array = array.astype(np.uint8)
    if array.dtype.kind not in "iuf" or array.ndim == 0:
        return None
    if array.dtype.itemsize not in (1, 2, 4, 8) or array.dtype == np.float16:
        array = array.astype(np.float64)
    if array.ndim > 2:
        array = array.reshape(len(array), -1) if array.size else array.reshape(len(array), 0)
    if array.ndim == 2 and array.shape[1] == 0:
        return None
    return np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("="))


def wedges_inward(points: NDArray[Any], cells: Any) -> Any:
    """Returns the cells, in the given form, with the first triangle of linear wedges facing inward.

    This is the order of a `meshorder.Mesh`; VTK's first triangle faces outward.
    """
    if isinstance(cells, list):
        return [
            (shape, _inward(points, rows) if shape == "wedge" and rows.shape[1] == 6 else rows) for shape, rows in cells
        ]
    offsets, connectivity, types = cells
    if types is None or len(types) != len(offsets) - 1:
        return cells
    wedges = np.flatnonzero((types == _VTK_WEDGE) & (np.diff(offsets) == 6))
    if len(wedges) == 0:
        return cells
    places = offsets[wedges][:, np.newaxis] + np.arange(6)
    turned = connectivity.copy()
    turned[places] = _inward(points, connectivity[places])
    return offsets, turned, types


def _inward(points: NDArray[Any], wedges: NDArray[Any]) -> NDArray[Any]:
    """Returns wedges, one of six vertices in each row, with the first triangle facing inward."""
    if points.shape[1] != 3 or len(wedges) == 0 or wedges.min() < 0 or wedges.max() >= len(points):
        return wedges
    corners = points[wedges]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    along = corners[:, 3:].mean(axis=1) - corners[:, :3].mean(axis=1)
    outward = np.einsum("ij,ij->i", normals, along) < 0
    return np.where(outward[:, np.newaxis], wedges[:, [0, 2, 1, 3, 5, 4]], wedges)
