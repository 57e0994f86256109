# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders of meshes that many ranks share, for programs with mpi4py or petsc4py.

Needs the library ``libmeshorder_mpi``. No wheel contains it, as it has to be built for the MPI of the machine: a build
with ``MESHORDER_MPI=ON`` installs it. The system's usual search finds it; the environment variable
``MESHORDER_MPI_LIBRARY`` names another file. A call::

    from mpi4py import MPI
    import meshorder.mpi

    order = meshorder.mpi.order_ranks(MPI.COMM_WORLD, own_vertices, tetrahedra)

Vertices are numbered across the ranks from 0 on: first those that rank 0 owns, then those of rank 1, and so on.
"""

from __future__ import annotations

import ctypes
import ctypes.util
import dataclasses
import functools
import os
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _errors
from ._arrays import integers
from ._arrays import points as as_points
from ._options import in_a_line, whole

__all__ = ["PartOrder", "RankOrder", "order_parts", "order_ranks"]

Numbers = NDArray[np.int64]
_LIBRARY = "libmeshorder_mpi.so.1"
_KINDS = {1: _errors.InvalidArgument, 2: _errors.InputError, 3: _errors.TooLarge, 4: _errors.Unavailable,
          5: _errors.Stopped, 7: _errors.InternalError}  # fmt: skip
_OUT_OF_MEMORY = 8
_MOST_VERTICES = 2**63 - 1
_FEW_CELLS = 27  # a transposed array has a row for each corner of a cell
_MANY_CORNERS = 125
_Prepared = TypeVar("_Prepared")


@dataclasses.dataclass(frozen=True)
class RankOrder:
    """The order of one rank's vertices and elements.

    Attributes:
        new_numbers: the new number, across the ranks, of each vertex that the rank owns; it stays among the numbers of
            the rank's own vertices. int64.
        cell_order: the old places of the rank's elements in their new order, by the element method "lexmax":
            ``cells[order.cell_order]`` moves them. int64.
    """

    new_numbers: Numbers
    cell_order: Numbers


@dataclasses.dataclass(frozen=True)
class PartOrder:
    """The parts of a mesh, numbered one after another, and the order of the vertices in them.

    Attributes:
        new_numbers: the new number, across all parts, of each vertex that the rank owns. int64.
        part_starts: parts + 1 numbers, the same on all ranks: part p has the new numbers from ``part_starts[p]`` to
            below ``part_starts[p + 1]``; vertices that no element uses have the numbers from ``part_starts[-1]`` on. int64.
        cell_parts: the part of each element of the rank: that of its vertex with the largest new number. int64.
    """

    new_numbers: Numbers
    part_starts: Numbers
    cell_parts: Numbers


_NUMBERS = ctypes.POINTER(ctypes.c_int64)


class _Mesh(ctypes.Structure):
    _fields_ = (("struct_size", ctypes.c_size_t), ("vertex_count", ctypes.c_int64), ("cell_count", ctypes.c_int64),
                ("cell_offsets", _NUMBERS), ("cell_vertices", _NUMBERS), ("points", ctypes.POINTER(ctypes.c_double)),
                ("cell_vertex_count", ctypes.c_int64), ("coordinate_count", ctypes.c_int64))  # fmt: skip


class _Options(ctypes.Structure):
    _fields_ = (("struct_size", ctypes.c_size_t), ("method", ctypes.c_char_p), ("partition", ctypes.c_char_p),
                ("balance", ctypes.c_char_p), ("seed", ctypes.c_uint64), ("parts", ctypes.c_int32),
                ("threads", ctypes.c_int32), ("interface_last", ctypes.c_int32), ("reserved", ctypes.c_int32))  # fmt: skip


@functools.cache
def _library() -> ctypes.CDLL:
    name = os.environ.get("MESHORDER_MPI_LIBRARY", _LIBRARY)
    try:
        # the MPI library that mpi4py has loaded is found by its name
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
    return np.empty(count, np.int64)


def _text(value: Any, name: str) -> bytes:
    if not isinstance(value, str):
        raise _errors.InvalidArgument(f"{name}: expected a text, not {in_a_line(value)}")
    return value.encode()


def _check_communicator(value: Any) -> None:
    if hasattr(value, "allgather") and hasattr(value, "py2f"):
        return
    if hasattr(value, "tompi4py"):
        remedy = "petsc4py's communicators become one with .tompi4py()"
    else:
        remedy = "comm.py2f() is for C"
    raise _errors.InvalidArgument(f"communicator: expected one of mpi4py ({remedy}), not {type(value).__name__}")


@dataclasses.dataclass
class _Arrays:
    """The arrays of a rank in the types that C reads, kept alive during the call."""

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
                raise _errors.InvalidArgument(
                    f"cells: expected m × k numbers, or (offsets, vertices), not the shape {rows.shape}"
                )
            width = rows.shape[1] if rows.ndim == 2 else 0
            if 0 < len(rows) <= _FEW_CELLS and width > _MANY_CORNERS:
                raise _errors.InvalidArgument(
                    f"cells: {width} vertices each: is the array transposed? A row for each cell is expected"
                )
            offsets = width * np.arange(len(rows) + 1, dtype=np.int64)
            vertices = rows.reshape(-1)
        if offsets.size == 0 or offsets[-1] != vertices.size:
            raise _errors.InvalidArgument(
                f"cells: the last of the offsets must be the length of the vertices, {vertices.size}"
            )
        placed = None
        if points is not None:
            placed = np.zeros((vertex_count, 3))
            given = as_points(points)
            if len(given) != vertex_count:
                raise _errors.InvalidArgument(f"points: expected {vertex_count} of them, not {len(given)}")
            placed[:, : given.shape[1]] = given
        return cls(vertex_count, offsets, vertices, placed)

    def to_c(self) -> _Mesh:
        points = None if self.points is None else self.points.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        return _Mesh(ctypes.sizeof(_Mesh), self.vertex_count, len(self.offsets) - 1, _numbers(self.offsets),
                     _numbers(self.vertices), points, self.vertices.size,
                     0 if self.points is None else self.points.size)  # fmt: skip


def _on_all_ranks(communicator: Any, prepare: Callable[[], _Prepared]) -> _Prepared:
    """Returns the result of ``prepare`` on this rank. If one rank raises, all do, so that none waits for it."""
    _check_communicator(communicator)
    prepared: _Prepared | None = None
    failure: Exception | None = None
    try:
        prepared = prepare()
    except Exception as error:  # noqa: BLE001, as the other ranks have to learn of it
        failure = error
    failures = communicator.allgather(None if failure is None else (type(failure).__name__, str(failure)))
    if failure is not None:
        raise failure
    for rank, found in enumerate(failures):
        if found is not None:
            kind, message = found
            known = {MemoryError.__name__: MemoryError, **{name: getattr(_errors, name) for name in _errors.__all__}}
            raise known.get(kind, _errors.Error)(f"rank {rank}: {message}")
    assert prepared is not None
    return prepared


def _call(function: Any, communicator: Any, arrays: _Arrays, options: _Options, *results: Numbers) -> None:
    mesh = arrays.to_c()
    status = function(ctypes.c_int32(communicator.py2f()), ctypes.byref(mesh), ctypes.byref(options),
                      *(_numbers(result) for result in results))  # fmt: skip
    # the statuses are those of mo_status in meshorder.h
    if status == 0:
        return
    message = _library().mo_mpi_last_error().decode()
    if status == _OUT_OF_MEMORY:
        raise MemoryError(message)
    raise _KINDS.get(status, _errors.Error)(message)


def order_ranks(communicator: Any, vertex_count: int, cells: ArrayLike | tuple[ArrayLike, ArrayLike],
                points: ArrayLike | None = None, *, method: str = "spectral", interface_last: bool = False,
                seed: int = 0, threads: int = 1) -> RankOrder:  # fmt: skip
    """Orders the vertices of every rank among themselves: each stays with its owner.

    Every rank must call this function, with the same ``method``, ``interface_last`` and ``seed``.

    Args:
        communicator: mpi4py communicator of the ranks that share the mesh; from petsc4py ``comm.tompi4py()``.
        vertex_count: number of vertices that this rank owns.
        cells: the elements that this rank has, as the numbers of their vertices across the ranks, whichever rank owns
            them: m rows of k vertices, or ``(offsets, vertices)``. An element may be on several ranks. Elements of more
            than 125 vertices need the second form where a rank has fewer than 28: else they are taken for transposed.
        points: coordinates of the rank's own vertices, ``vertex_count`` rows of one to three, on all ranks or on none.
            Geometric methods need them.
        method: name of a vertex method, but not "auto", "original" or "scrambled".
        interface_last: True numbers the vertices that share an element with vertices of other ranks after the others.
        seed: integer ≥ 0 for the method.
        threads: limit on the threads of this rank.

    Returns:
        New numbers of this rank's vertices, and the order of its elements.

    Raises:
        InvalidArgument: an unknown method, wrong vertex numbers, missing coordinates, arrays of wrong shapes, another
            kind of communicator, options (except ``threads``) that differ between ranks.
        Unavailable: the library ``libmeshorder_mpi`` was not found.
        Error: another failure.

    If one rank raises, all do.
    """

    def prepare() -> tuple[_Arrays, _Options, RankOrder]:
        _library()
        own = whole(vertex_count, _MOST_VERTICES, "vertex_count")
        arrays = _Arrays.of(own, cells, points)
        options = _Options(ctypes.sizeof(_Options), _text(method, "method"), None, None, whole(seed, 2**64 - 1, "seed"), 0,
                           whole(threads, 2**31 - 1, "threads"), bool(interface_last), 0)  # fmt: skip
        return arrays, options, RankOrder(_room_for(own), _room_for(len(arrays.offsets) - 1))

    arrays, options, order = _on_all_ranks(communicator, prepare)
    _call(_library().mo_mpi_order_ranks, communicator, arrays, options, order.new_numbers, order.cell_order)
    return order


def order_parts(communicator: Any, vertex_count: int, cells: ArrayLike | tuple[ArrayLike, ArrayLike],
                points: ArrayLike, *, parts: int = 0, method: str = "spectral", partition: str = "ptscotch",
                balance: str = "vertices", interface_last: bool = False, seed: int = 0,
                threads: int = 1) -> PartOrder:  # fmt: skip
    """Cuts the mesh into parts, orders the vertices of each, and numbers the parts one after another.

    Parts that touch get numbers near each other. The caller moves vertices and elements to their new owners. Every rank
    must call this function, with the same options.

    Args:
        communicator: as for `order_ranks`.
        vertex_count: number of vertices that this rank owns.
        cells: the elements that this rank has, in a form that `order_ranks` takes; each element is on one rank only.
        points: coordinates of the rank's own vertices, ``vertex_count`` rows of one to three.
        parts: number of parts, at most the number of vertices; 0: one for each rank.
        method: name of the vertex method for the parts, but not "auto", "original" or "scrambled".
        partition: the method that makes the parts: "ptscotch", which needs MPI_THREAD_MULTIPLE and is replaced by
            "hilbert" without it; "hilbert"; "rsb", recursive spectral bisection; or "order", which orders the whole
            mesh and cuts the order into equal ranges. "order" needs the method "fiedler", the balance "vertices" and
            ``interface_last=False``.
        balance: whether parts get the same number of "vertices" or of "cells".
        interface_last: True numbers the vertices that share an element with vertices of other parts after the others
            of their part.
        seed: integer ≥ 0 for the method.
        threads: limit on the threads of this rank.

    Returns:
        New numbers of this rank's vertices, the ranges of the parts, and the part of each of its elements.

    Raises:
        InvalidArgument, Unavailable, Error: as `order_ranks`; InvalidArgument also for more parts than vertices and for
            options that contradict each other.
    """

    def prepare() -> tuple[_Arrays, _Options, int]:
        _library()
        own = whole(vertex_count, _MOST_VERTICES, "vertex_count")
        count = whole(parts, 2**31 - 1, "parts")
        arrays = _Arrays.of(own, cells, points)
        options = _Options(ctypes.sizeof(_Options), _text(method, "method"), _text(partition, "partition"),
                           _text(balance, "balance"), whole(seed, 2**64 - 1, "seed"), count,
                           whole(threads, 2**31 - 1, "threads"), bool(interface_last), 0)  # fmt: skip
        return arrays, options, count

    arrays, options, count = _on_all_ranks(communicator, prepare)
    own = arrays.vertex_count
    vertices = sum(communicator.allgather(own))
    room = min(count, vertices) if count else communicator.size  # more parts than vertices are refused
    order = _on_all_ranks(communicator, lambda: PartOrder(_room_for(own), _room_for(room + 1),
                                                          _room_for(len(arrays.offsets) - 1)))  # fmt: skip
    _call(_library().mo_mpi_order_parts, communicator, arrays, options, order.new_numbers, order.part_starts,
          order.cell_parts)  # fmt: skip
    return order
