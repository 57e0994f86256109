# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The problem that the kernels solve on a mesh, and its arrays in an order."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._layouts import sort_corners
from .._meshes import SHAPES, Mesh
from .._orders import order_edges, order_mesh
from .._permutation import Permutation

#: default element method by vertex method; "lexmax" for the methods that are not listed
_ELEMENTS_OF = {"original": "original", "auto": "auto", "scrambled": "scrambled"}
_SORTED = "+corners"
_USUAL = ("auto", "auto+corners", "hilbert", "rcm", "spectral", "fiedler", "hilbert/original", "scrambled")
_LEAST_VOLUME = 1e-9  # of a tetrahedron with a force, relative to the cube of its longest edge at its first corner

Rows = NDArray[np.int32]
Single = NDArray[np.float32]


class Problem:
    """A mesh in its own order: elastic tetrahedra, and springs along the edges.

    Attributes:
        mesh: the mesh.
        rest: n × 3: the mesh's points, moved and scaled so that their box has the longest side 1 and its centre at 0.
        now: n × 3, the points as a smooth deformation has moved them, by up to 0.02.
        offsets, neighbours: the graph of its vertices.
        springs: the edges of the graph, m × 2.
        tetrahedra: the linear tetrahedra, e × 4.
    """

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
        extent = float((high - low).max())
        self.has_places = extent > 0
        self.rest: Single = ((mesh.points - (low + high) / 2) / (extent or 1)).astype(np.float32)
        self.now: Single = (self.rest + 0.02 * np.sin(3 * self.rest[:, [1, 2, 0]])).astype(np.float32)
        self.offsets, self.neighbours = mesh._handle.graph()
        rows = np.repeat(np.arange(len(mesh.points), dtype=np.int32), np.diff(self.offsets))
        once = rows < self.neighbours
        self.springs: Rows = np.stack([rows[once], self.neighbours[once]], axis=1)
        widths = np.diff(mesh.offsets)
        self._places = np.flatnonzero((mesh.shapes == SHAPES.index("tetrahedron")) & (widths == 4))
        corners = mesh.offsets[:-1][self._places, np.newaxis] + np.arange(4)
        self.tetrahedra: Rows = mesh.connectivity[corners]

    def tetrahedra_in(self, cells: Permutation) -> NDArray[np.int64]:
        """Returns the old number of each tetrahedron in an order of all cells."""
        number = np.full(len(cells), -1, dtype=np.int64)
        number[self._places] = np.arange(len(self._places))
        moved = number[cells.new_to_old]
        return moved[moved >= 0]

    @cached_property
    def gradients(self) -> Gradients:
        """The gradients of the tetrahedra at rest."""
        return gradients(self.rest, self.tetrahedra)


class Gradients(NamedTuple):
    """Derivatives of the coordinates of points in tetrahedra.

    Attributes:
        of: e × 3 × 3: the gradient of corner 1, 2 or 3 by coordinate; 0 in flat tetrahedra.
        volume: e numbers.
    """

    of: NDArray[np.float64]
    volume: NDArray[np.float64]

    def runs(self) -> Single:
        """Returns the ten arrays of numbers that the kernels read, as rows."""
        return np.concatenate([self.of.reshape(-1, 9).T, self.volume[np.newaxis]]).astype(np.float32)


def gradients(points: Single, tetrahedra: Rows) -> Gradients:
    """Returns the gradients of tetrahedra at rest."""
    corners = points.astype(np.float64)[tetrahedra]
    a, b, c = np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 0)
    found = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    six = np.einsum("ij,ij->i", a, found[:, 0])
    longest = np.sqrt(np.max([np.einsum("ij,ij->i", edge, edge) for edge in (a, b, c)], axis=0))
    flat = np.abs(six) <= _LEAST_VOLUME * longest**3
    found /= np.where(flat, np.inf, six)[:, np.newaxis, np.newaxis]
    return Gradients(found, np.where(flat, 0, np.abs(six) / 6))


class Ordered:
    """A problem in an order.

    Attributes:
        name: "original", or the order's name: "rcm" for "rcm/lexmax", "hilbert/original", "rcm+corners".
        methods: of the vertices and the elements; never "auto".
        by_auto: whether `auto` chose the methods.
        sorts_corners: whether the corners of tetrahedra are sorted.
        seconds: time that the order took.
        vertices: the order of the vertices.
        tetrahedra, springs: with the new numbers of their vertices, in their new order.
        now: the points, in their new order.
    """

    def __init__(self, problem: Problem, name: str, options: dict[str, Any]) -> None:
        both, self.sorts_corners = name.removesuffix(_SORTED), name.endswith(_SORTED)
        vertices, _, elements = both.partition("/")
        elements = elements or _ELEMENTS_OF.get(vertices, "lexmax")
        self.by_auto = both == "auto"
        began = time.perf_counter()
        found = order_mesh(problem.mesh, vertices=vertices, elements=elements, **{**options, "workload": "gpu"})
        self.seconds = time.perf_counter() - began
        self.problem = problem
        self.vertices = found.vertices.permutation
        self.methods = found.vertices.method, found.cells.method
        self.name = self._name()
        self._old_tetrahedra = problem.tetrahedra_in(found.cells.permutation)
        new = self.vertices.renumber(problem.tetrahedra[self._old_tetrahedra])
        self.tetrahedra: Rows = sort_corners(new) if self.sorts_corners and len(new) else new
        self.springs = self._springs()
        self.now: Single = self.vertices.move(problem.now)

    def _name(self) -> str:
        vertices, elements = self.methods
        usual = elements == _ELEMENTS_OF.get(vertices, "lexmax")
        return (vertices if usual else f"{vertices}/{elements}") + (_SORTED if self.sorts_corners else "")

    def _springs(self) -> Rows:
        """Returns the springs: unchanged or scrambled like the elements, otherwise sorted by `order_edges`."""
        springs = self.problem.springs
        if self.methods[1] == "scrambled":
            springs = np.random.default_rng(0).permutation(springs)
        elif self.methods[1] != "original":
            springs = order_edges(springs, self.vertices).move(springs)
        ends: Rows = self.vertices.renumber(springs)
        return ends

    def gradients(self) -> Gradients:
        """Returns the gradients of the tetrahedra at rest, in their new order."""
        if self.sorts_corners:
            return gradients(self.rest, self.tetrahedra)
        of, volume = self.problem.gradients
        return Gradients(of[self._old_tetrahedra], volume[self._old_tetrahedra])

    @cached_property
    def rest(self) -> Single:
        """The points at rest, in their new order."""
        moved: Single = self.vertices.move(self.problem.rest)
        return moved

    @cached_property
    def graph(self) -> tuple[Rows, Rows]:
        """Offsets and neighbours of the vertices with their new numbers, neighbours ascending."""
        old = self.problem.offsets, self.problem.neighbours
        degrees = np.diff(old[0])
        rows = np.repeat(self.vertices.old_to_new, degrees).astype(np.int64)
        entries = np.sort(rows * len(degrees) + self.vertices.renumber(old[1]))
        offsets = np.zeros(len(degrees) + 1, dtype=np.int32)
        np.cumsum(self.vertices.move(degrees), out=offsets[1:])
        return offsets, (entries % max(len(degrees), 1)).astype(np.int32)


def lengths(points: Single, first: Rows, second: Rows) -> Single:
    """Returns the distance between each pair of points."""
    difference = points[first].astype(np.float64) - points[second]
    found: Single = np.sqrt(np.einsum("ij,ij->i", difference, difference)).astype(np.float32)
    return found


def ordered(problem: Problem, names: Sequence[str] | None, options: dict[str, Any]) -> list[Ordered]:
    """Returns a problem in its own order and in others; orders that equal an earlier one are left out.

    Args:
        problem: the problem.
        names: names of the orders; None: the usual orders, without orders along curves if the mesh has no coordinates.
        options: see `Options`.
    """
    if names is None:
        names = [name for name in _USUAL if problem.has_places or not name.startswith("hilbert")]
        names = [name for name in names if len(problem.tetrahedra) or not name.endswith(_SORTED)]
    found = [Ordered(problem, "original", options)]
    for name in names:
        made = Ordered(problem, name, options)
        equal = [earlier for earlier in found if earlier.name == made.name]
        if not equal:
            found.append(made)
        elif made.by_auto:
            equal[0].by_auto = True
    return found
