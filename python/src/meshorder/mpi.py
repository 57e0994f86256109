# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders of meshes that many ranks share, for programs with mpi4py or petsc4py.

Needs ``libmeshorder_mpi``, which a build with ``MESHORDER_MPI=ON`` installs: it is made for the MPI of the machine, as no
wheel can be. It is looked for where the system looks for libraries; ``MESHORDER_MPI_LIBRARY`` names another file.

    >>> from mpi4py import MPI
    >>> import meshorder.mpi
    >>> order = meshorder.mpi.order_ranks(MPI.COMM_WORLD, own_vertices, tetrahedra)

Vertices are numbered across the ranks from 0 on: those that rank 0 owns, those of rank 1, and so on.
"""

from __future__ import annotations

import ctypes
import ctypes.util
import dataclasses
import functools
import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _errors
from ._arrays import integers

__all__ = ["PartOrder", "RankOrder", "order_parts", "order_ranks"]

Numbers = NDArray[np.int64]
_LIBRARY = "libmeshorder_mpi.so.1"
_KINDS = {1: _errors.InvalidArgument, 2: _errors.InputError, 3: _errors.TooLarge, 4: _errors.Unavailable,
          5: _errors.Stopped, 7: _errors.InternalError}  # fmt: skip
_OUT_OF_MEMORY = 8


@dataclasses.dataclass(frozen=True)
class RankOrder:
    """Order of what a rank has.

    Attributes:
        new_numbers: new number of each own vertex, within the rank's own range.
        cell_order: old places of the elements in their new order, by ``lexmax``: ``cells[order.cell_order]``.
    """

    new_numbers: Numbers
    cell_order: Numbers


@dataclasses.dataclass(frozen=True)
class PartOrder:
    """Parts of a mesh, and the order in which they and their vertices follow each other.

    Attributes:
        new_numbers: new number of each own vertex.
        part_starts: first new number of each part, and the end of the last one's; vertices that no element uses have the
            numbers from there on.
        cell_parts: part of each element, that of its vertex with the largest new number.
    """

    new_numbers: Numbers
    part_starts: Numbers
    cell_parts: Numbers


_NUMBERS = ctypes.POINTER(ctypes.c_int64)


class _Mesh(ctypes.Structure):
    _fields_ = (("struct_size", ctypes.c_size_t), ("vertex_count", ctypes.c_int64), ("cell_count", ctypes.c_int64),
                ("cell_offsets", _NUMBERS), ("cell_vertices", _NUMBERS), ("points", ctypes.POINTER(ctypes.c_double)))  # fmt: skip


class _Options(ctypes.Structure):
    _fields_ = (("struct_size", ctypes.c_size_t), ("method", ctypes.c_char_p), ("partition", ctypes.c_char_p),
                ("balance", ctypes.c_char_p), ("seed", ctypes.c_uint64), ("parts", ctypes.c_int32),
                ("threads", ctypes.c_int32), ("interface_last", ctypes.c_int32), ("reserved", ctypes.c_int32))  # fmt: skip


@functools.cache
def _library() -> ctypes.CDLL:
    name = os.environ.get("MESHORDER_MPI_LIBRARY", _LIBRARY)
    try:
        # MPI is the process's own, by the name that mpi4py loaded it under
        library = ctypes.CDLL(name)
    except OSError as error:
        raise _errors.Unavailable(f"{name} was not found ({error}): install a build with MESHORDER_MPI=ON, or let "
                                  "MESHORDER_MPI_LIBRARY name the file") from None  # fmt: skip
    library.mo_mpi_last_error.restype = ctypes.c_char_p
    return library


def _numbers(array: NDArray[Any]) -> Any:
    return array.ctypes.data_as(_NUMBERS)


def _whole_numbers(values: ArrayLike) -> Numbers:
    return np.ascontiguousarray(integers(values, "cells", rank=None), np.int64)


def _room_for(count: int) -> Numbers:
    """Room for so many numbers. A negative count is for the library to refuse, on all ranks."""
    return np.empty(max(count, 0), np.int64)


@dataclasses.dataclass
class _Arrays:
    """The arrays of a rank, kept as long as C reads them."""

    vertex_count: int
    offsets: Numbers
    vertices: Numbers
    points: NDArray[np.float64] | None

    @classmethod
    def of(cls, vertex_count: int, cells: ArrayLike | tuple[ArrayLike, ArrayLike], points: ArrayLike | None) -> _Arrays:
        if isinstance(cells, tuple):
            offsets, vertices = (_whole_numbers(part) for part in cells)
        else:
            rows = _whole_numbers(cells)
            if rows.ndim != 2 and rows.size > 0:
                raise _errors.InvalidArgument(f"cells: {rows.ndim} dimensions; give m × k numbers, or (offsets, vertices)")
            width = rows.shape[1] if rows.ndim == 2 else 0
            offsets = width * np.arange(len(rows) + 1, dtype=np.int64)
            vertices = rows.reshape(-1)
        if offsets.size == 0 or offsets[-1] != vertices.size:
            raise _errors.InvalidArgument(f"cells: {vertices.size} vertices do not fit the offsets")
        placed = None
        if points is not None:
            placed = np.zeros((max(vertex_count, 0), 3))
            given = np.asarray(points, np.float64)
            if given.ndim != 2 or len(given) != vertex_count or not 1 <= given.shape[1] <= 3:
                raise _errors.InvalidArgument(f"points: {given.shape}, must be {vertex_count} × 1, 2 or 3")
            placed[:, : given.shape[1]] = given
        return cls(vertex_count, offsets, vertices, placed)

    def to_c(self) -> _Mesh:
        points = None if self.points is None else self.points.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        return _Mesh(ctypes.sizeof(_Mesh), self.vertex_count, len(self.offsets) - 1, _numbers(self.offsets),
                     _numbers(self.vertices), points)  # fmt: skip


def _call(function: Any, communicator: Any, arrays: _Arrays, options: _Options, *results: Numbers) -> None:
    mesh = arrays.to_c()
    status = function(ctypes.c_int32(communicator.py2f()), ctypes.byref(mesh), ctypes.byref(options),
                      *(_numbers(result) for result in results))  # fmt: skip
    if status == 0:
        return
    message = _library().mo_mpi_last_error().decode()
    if status == _OUT_OF_MEMORY:
        raise MemoryError(message)
    raise _KINDS.get(status, _errors.Error)(message)


def order_ranks(communicator: Any, vertex_count: int, cells: ArrayLike | tuple[ArrayLike, ArrayLike],
                points: ArrayLike | None = None, *, method: str = "spectral", interface_last: bool = False,
                seed: int = 0, threads: int = 1) -> RankOrder:  # fmt: skip
    """Orders the vertices of every rank among themselves: each stays with its owner. Every rank has to call it.

    Args:
        communicator: of mpi4py, of the ranks that share the mesh.
        vertex_count: vertices that this rank owns.
        cells: elements that this rank has, by the numbers of their vertices, whichever rank owns these: m × k, or
            (offsets, vertices). Elements may be on several ranks.
        points: n × 1, 2 or 3 coordinates of the own vertices, on all ranks or on none.
        method: vertex method.
        interface_last: True puts vertices that share an element with those of other ranks behind the others.
        seed: of the method.
        threads: of this rank.

    Raises:
        Error: on all ranks where one fails, but for arrays of wrong shapes, which only their rank sees.
    """
    arrays = _Arrays.of(vertex_count, cells, points)
    options = _Options(ctypes.sizeof(_Options), method.encode(), None, None, seed, 0, threads, interface_last, 0)
    order = RankOrder(_room_for(vertex_count), _room_for(len(arrays.offsets) - 1))
    _call(_library().mo_mpi_order_ranks, communicator, arrays, options, order.new_numbers, order.cell_order)
    return order


def order_parts(communicator: Any, vertex_count: int, cells: ArrayLike | tuple[ArrayLike, ArrayLike],
                points: ArrayLike, *, parts: int = 0, method: str = "spectral", partition: str = "ptscotch",
                balance: str = "vertices", interface_last: bool = False, seed: int = 0,
                threads: int = 1) -> PartOrder:  # fmt: skip
    """Cuts the mesh into parts, orders each, and numbers them one after another, so that parts that touch are near each
    other. Moving vertices and elements to their new owners is left to the caller. Every rank has to call it.

    Args:
        communicator: of mpi4py, of the ranks that share the mesh.
        vertex_count: vertices that this rank owns.
        cells: as of `order_ranks`, each on one rank.
        points: n × 1, 2 or 3 coordinates of the own vertices.
        parts: number of parts; 0: one for each rank.
        method: vertex method of a part.
        partition: "ptscotch", which needs MPI_THREAD_MULTIPLE; "hilbert", which takes its place without that; "rsb",
            recursive spectral bisection; or "order", equal ranges of one order of the whole mesh, by the method "fiedler" only.
        balance: what every part gets the same number of, "vertices" or "cells".
        interface_last: True puts vertices that share an element with those of other parts behind the others.
        seed: of the method.
        threads: of this rank.

    Raises:
        Error: as `order_ranks`.
    """
    arrays = _Arrays.of(vertex_count, cells, points)
    options = _Options(ctypes.sizeof(_Options), method.encode(), partition.encode(), balance.encode(), seed, parts, threads,
                       interface_last, 0)  # fmt: skip
    order = PartOrder(_room_for(vertex_count), _room_for((parts or communicator.size) + 1),
                      _room_for(len(arrays.offsets) - 1))  # fmt: skip
    _call(_library().mo_mpi_order_parts, communicator, arrays, options, order.new_numbers, order.part_starts,
          order.cell_parts)  # fmt: skip
    return order
