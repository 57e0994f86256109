# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The kernels that are compared: their arrays, their launches and where they leave their results."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._layouts import colours, gather_lists, patches
from . import expected
from .device import BLOCK, Device, Launch
from .expected import Expected, Results
from .problem import Ordered, Problem, Single, lengths


class Run(NamedTuple):
    """A kernel that is ready to run in an order.

    Attributes:
        launches: the launches of its functions.
        result: the array on the device that it adds to or writes.
        read: returns the n × k results of the vertices from the values of that array.
        expected: returns the reference results, for vertices in their old order.
    """

    launches: list[Launch]
    result: Any
    read: Callable[[Single], Single]
    expected: Callable[[], Expected]


class Arrays:
    """The arrays of an order on the device. Each is uploaded when it is first used."""

    def __init__(self, device: Device, order: Ordered, results: Results) -> None:
        self.device = device
        self.order = order
        self.results = results
        self.n = len(order.now)

    @cached_property
    def packed(self) -> Any:
        return self.device.upload(self.order.now)

    @cached_property
    def apart(self) -> Any:
        return self.device.upload(self.in_three_runs(self.order.now))

    @cached_property
    def padded(self) -> Any:
        return self.device.upload(with_ones(self.order.now))

    @cached_property
    def matrix(self) -> tuple[Any, Any, Any]:
        return tuple(map(self.device.upload, expected.matrix(*self.order.graph)))

    @cached_property
    def corners(self) -> Any:
        return self.device.upload(self.order.tetrahedra)

    @cached_property
    def rest_on_host(self) -> Single:
        return self.order.gradients().runs()

    @cached_property
    def rest(self) -> Any:
        return self.device.upload(self.rest_on_host)

    @cached_property
    def springs(self) -> tuple[Any, Any]:
        ends = self.order.springs
        return self.device.upload(ends), self.device.upload(lengths(self.order.rest, ends[:, 0], ends[:, 1]))

    @property
    def stride(self) -> int:
        """Distance, in numbers, from all x to all y and from all y to all z: whole sectors of memory."""
        return -(-self.n // 8) * 8

    def in_three_runs(self, rows: Single) -> Single:
        runs = np.zeros((3, self.stride), dtype=np.float32)
        runs[:, : self.n] = rows.T
        return runs

    def run(self, launches: Callable[[Any], list[Launch]], start: Single, read: Callable[[Single], Single],
            of: Callable[[], Expected]) -> Run:  # fmt: skip
        result = self.device.upload(start)
        return Run(launches(result), result, read, of)


def with_ones(rows: Single) -> Single:
    """Returns the rows with a fourth number, 1."""
    return np.concatenate([rows, np.ones((len(rows), 1), dtype=np.float32)], axis=1)


def _three(values: Single) -> Single:
    return values[:, :3]


def _zeros(arrays: Arrays, width: int) -> Single:
    return np.zeros((arrays.n, width), dtype=np.float32)


def _product(kernel: str, lanes: int) -> Callable[[Arrays], Run]:
    def prepare(arrays: Arrays) -> Run:
        factor: Single = arrays.order.vertices.move(expected.factor(arrays.n))
        x = arrays.device.upload(factor)
        return arrays.run(
            lambda y: [Launch(kernel, lanes * arrays.n, (arrays.n, *arrays.matrix, x, y))],
            _zeros(arrays, 1), lambda y: y, lambda: arrays.results.product,
        )  # fmt: skip

    return prepare


def _forces(arrays: Arrays, launches: Callable[[int, Any], list[Launch]], start: Single,
            read: Callable[[Single], Single]) -> Run:  # fmt: skip
    n = len(arrays.order.tetrahedra)
    return arrays.run(
        lambda sums: launches(n, sums), start, read, lambda: arrays.results.forces
    )


def _forces_packed(arrays: Arrays) -> Run:
    given = arrays.corners, arrays.rest, arrays.packed
    return _forces(
        arrays, lambda n, sums: [Launch("forces_packed", n, (n, *given, sums))], _zeros(arrays, 3), _three
    )


def _forces_apart(arrays: Arrays) -> Run:
    given = arrays.stride, arrays.corners, arrays.rest, arrays.apart
    return _forces(
        arrays, lambda n, sums: [Launch("forces_apart", n, (n, *given, sums))],
        np.zeros((3, arrays.stride), dtype=np.float32), lambda sums: sums[:, : arrays.n].T,
    )  # fmt: skip


def _forces_padded(arrays: Arrays) -> Run:
    given = arrays.corners, arrays.rest, arrays.padded
    return _forces(
        arrays, lambda n, sums: [Launch("forces_padded", n, (n, *given, sums))], _zeros(arrays, 4), _three
    )


def _forces_patches(arrays: Arrays) -> Run:
    cut = patches(arrays.order.tetrahedra, BLOCK, vertices=arrays.n)
    given = (
        arrays.device.upload(cut.offsets.astype(np.int32)), arrays.device.upload(cut.vertices),
        arrays.device.upload(cut.local), arrays.device.upload(arrays.rest_on_host[:, cut.cells]),
    )  # fmt: skip
    shared = 24 * int(np.diff(cut.offsets).max())
    return _forces(
        arrays, lambda n, sums: [Launch("forces_patches", n, (n, *given, arrays.packed, sums), shared)],
        _zeros(arrays, 3), _three,
    )  # fmt: skip


def _forces_gathered(arrays: Arrays) -> Run:
    lists = gather_lists(arrays.order.tetrahedra, vertices=arrays.n)
    offsets = arrays.device.upload(lists.offsets.astype(np.int32))
    places = arrays.device.upload(4 * lists.cells + lists.corners)
    forces = arrays.device.upload(np.zeros((len(lists.cells), 4), dtype=np.float32))
    given = arrays.corners, arrays.rest, arrays.packed

    def launches(n: int, sums: Any) -> list[Launch]:
        return [
            Launch("corner_forces", n, (n, *given, forces)),
            Launch("sum_corners", arrays.n, (arrays.n, offsets, places, forces, sums)),
        ]

    return _forces(arrays, launches, _zeros(arrays, 3), _three)


def _springs(kernel: str, width: int) -> Callable[[Arrays], Run]:
    def prepare(arrays: Arrays) -> Run:
        n = len(arrays.order.springs)
        points = arrays.packed if width == 3 else arrays.padded
        return arrays.run(
            lambda sums: [Launch(kernel, n, (n, *arrays.springs, points, sums))],
            _zeros(arrays, width), _three, lambda: arrays.results.springs,
        )  # fmt: skip

    return prepare


def _springs_gathered(arrays: Arrays) -> Run:
    offsets, neighbours = arrays.order.graph
    rows = np.repeat(np.arange(arrays.n, dtype=np.int32), np.diff(offsets))
    given = tuple(
        map(arrays.device.upload, (offsets, neighbours, lengths(arrays.order.rest, rows, neighbours)))
    )
    return arrays.run(
        lambda sums: [Launch("springs_gathered", arrays.n, (arrays.n, *given, arrays.packed, sums))],
        _zeros(arrays, 3), _three, lambda: arrays.results.springs,
    )  # fmt: skip


def _distances(arrays: Arrays) -> Run:
    ends = arrays.order.springs
    found = colours(ends, vertices=arrays.n)
    ends = ends[found.cells]
    given = arrays.device.upload(ends), arrays.device.upload(lengths(arrays.order.rest, ends[:, 0], ends[:, 1]))

    def launches(points: Any) -> list[Launch]:
        return [
            Launch("distances", end - begin, (end - begin, begin, *given, points))
            for begin, end in zip(found.starts.tolist(), found.starts[1:].tolist())
        ]

    return arrays.run(
        launches, with_ones(arrays.order.now), _three,
        lambda: expected.distances(arrays.order, found.starts, ends),
    )  # fmt: skip


class Kernel(NamedTuple):
    """A kernel, or two in succession, with a column in the table.

    Attributes:
        name: in JSON.
        group: "product", "element forces" or "springs".
        title: its title in the group.
        prepare: uploads its arrays.
    """

    name: str
    group: str
    title: str
    prepare: Callable[[Arrays], Run]


_PRODUCTS = [
    Kernel("product_rows", "product", "rows", _product("product_rows", 1)),
    Kernel("product_lanes", "product", "8 lanes", _product("product_lanes", 8)),
]
_FORCES = [
    Kernel("forces_packed", "element forces", "packed", _forces_packed),
    Kernel("forces_apart", "element forces", "apart", _forces_apart),
    Kernel("forces_padded", "element forces", "padded", _forces_padded),
    Kernel("forces_patches", "element forces", "patches", _forces_patches),
    Kernel("forces_gathered", "element forces", "gathered", _forces_gathered),
]
_SPRINGS = [
    Kernel("springs_packed", "springs", "packed", _springs("springs_packed", 3)),
    Kernel("springs_padded", "springs", "padded", _springs("springs_padded", 4)),
    Kernel("springs_gathered", "springs", "gathered", _springs_gathered),
    Kernel("distances", "springs", "colours", _distances),
]


def kernels_for(problem: Problem) -> list[list[Kernel]]:
    """Returns the kernels that a problem has work for, group by group."""
    groups = [_PRODUCTS]
    if len(problem.tetrahedra) and problem.has_places:
        groups.append(_FORCES)
    if len(problem.springs) and problem.has_places:
        groups.append(_SPRINGS)
    return groups
