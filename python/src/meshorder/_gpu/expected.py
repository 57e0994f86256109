# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Reference results of the kernels, computed with NumPy in double precision."""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .problem import Ordered, Problem, Rows, Single, lengths

Double = NDArray[np.float64]


class Expected(NamedTuple):
    """Results of a kernel.

    Attributes:
        values: n × k numbers, for vertices in their old order.
        scale: n numbers ≥ 0: for each vertex, the sum of bounds on the sizes of its terms.
    """

    values: Double
    scale: Double

    def error(self, found: NDArray[Any]) -> float:
        """Returns the largest difference relative to the scale; NaN if a number is NaN."""
        difference = np.abs(found - self.values).max(axis=1, initial=0)
        return float((difference / np.maximum(self.scale, np.finfo(np.float32).tiny)).max(initial=0))


def _summed(vertices: NDArray[Any], terms: Double, n: int) -> Double:
    """Returns for each vertex the sum of its rows of terms."""
    columns = [np.bincount(vertices, weights=column, minlength=n) for column in terms.reshape(len(terms), -1).T]
    return np.stack(columns, axis=1)


def factor(n: int) -> Single:
    """Returns the vector with which the matrix is multiplied."""
    return (1 + np.sin(np.arange(n))[:, np.newaxis] / 2).astype(np.float32)


def matrix(offsets: NDArray[Any], neighbours: Rows) -> tuple[Rows, Rows, Single]:
    """Returns offsets, columns and values of L + I, where L is the Laplacian of a graph whose neighbours ascend."""
    degrees = np.diff(offsets)
    n = len(degrees)
    rows = np.repeat(np.arange(n, dtype=np.int32), degrees)
    before = np.bincount(rows[neighbours < rows], minlength=n)
    places = offsets[:-1] + before
    columns = np.insert(neighbours, places, np.arange(n, dtype=np.int32))
    values = np.insert(np.full(len(neighbours), -1, dtype=np.float32), places, (degrees + 1).astype(np.float32))
    return (offsets + np.arange(n + 1)).astype(np.int32), columns, values


def _pulls(points: Double, ends: Rows, rest: NDArray[Any]) -> tuple[Double, Double]:
    """Returns the force of each spring on its first end, and a bound on the size of that force."""
    along = points[ends[:, 1]] - points[ends[:, 0]]
    now = np.linalg.norm(along, axis=1)
    stretched = np.where(now > 0, 1 - rest / np.where(now > 0, now, 1), 0)
    return stretched[:, np.newaxis] * along, now + rest


def _scale_of(ends: Rows, bounds: Double, n: int) -> Double:
    return np.asarray(_summed(ends.T.ravel(), np.tile(bounds, 2), n)[:, 0])


class Results:
    """Reference results of the kernels on a problem, for any order. Each is computed when it is first used.

    Attributes:
        problem: the problem.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    @cached_property
    def product(self) -> Expected:
        """Returns the product of the matrix with the vector."""
        degrees = np.diff(self.problem.offsets)
        x = factor(len(degrees)).astype(np.float64)
        rows = np.repeat(np.arange(len(degrees)), degrees)
        of_neighbours = _summed(rows, x[self.problem.neighbours], len(degrees))
        own = (degrees + 1)[:, np.newaxis] * x
        return Expected(own - of_neighbours, (own + of_neighbours)[:, 0])

    @cached_property
    def forces(self) -> Expected:
        """Returns the sums of the elastic forces of tetrahedra, for small strains."""
        tetrahedra = self.problem.tetrahedra
        corners = self.problem.now.astype(np.float64)[tetrahedra]
        edges = corners[:, 1:] - corners[:, :1]
        rest = self.problem.gradients
        displaced = np.einsum("eki,ekj->eij", edges, rest.of) - np.eye(3)
        stress = displaced + displaced.transpose(0, 2, 1)
        stress += np.trace(displaced, axis1=1, axis2=2)[:, np.newaxis, np.newaxis] * np.eye(3)
        of_corners = -rest.volume[:, np.newaxis, np.newaxis] * np.einsum("eij,ekj->eki", stress, rest.of)
        of_corners = np.concatenate([-of_corners.sum(axis=1, keepdims=True), of_corners], axis=1)
        # bounds on the forces, from norms
        steepness = np.linalg.norm(rest.of, axis=2)
        stretch = 1 + np.einsum("ek,ek->e", np.linalg.norm(edges, axis=2), steepness)
        bounds = (rest.volume * stretch)[:, np.newaxis] * steepness
        bounds = np.concatenate([bounds.sum(axis=1, keepdims=True), bounds], axis=1)
        vertices = tetrahedra.ravel()
        return Expected(
            _summed(vertices, of_corners.reshape(-1, 3), len(self.problem.now)),
            _summed(vertices, bounds.reshape(-1, 1), len(self.problem.now))[:, 0],
        )

    @cached_property
    def springs(self) -> Expected:
        """Returns the sums of the forces of springs."""
        ends, n = self.problem.springs, len(self.problem.now)
        pulls, bounds = _pulls(self.problem.now.astype(np.float64), ends, lengths(self.problem.rest, ends[:, 0], ends[:, 1]))
        sums = _summed(ends.T.ravel(), np.concatenate([pulls, -pulls]), n)
        return Expected(sums, _scale_of(ends, bounds, n))


def distances(order: Ordered, starts: NDArray[np.int32], ends: Rows) -> Expected:
    """Returns the points after all springs have been moved to their rest lengths, one colour after another.

    Args:
        order: the order.
        starts: the springs of colour c are ``starts[c]`` to below ``starts[c + 1]``.
        ends: both ends of each spring, colour after colour.
    """
    points = order.now.astype(np.float64)
    rest = lengths(order.rest, ends[:, 0], ends[:, 1])
    _, bounds = _pulls(points, ends, rest)
    for begin, end in zip(starts, starts[1:]):
        of_colour = ends[begin:end]
        half = _pulls(points, of_colour, rest[begin:end])[0] / 2
        points[of_colour[:, 0]] += half
        points[of_colour[:, 1]] -= half
    back = order.vertices.inverse()
    return Expected(back.move(points), back.move(_scale_of(ends, bounds, len(points))))
