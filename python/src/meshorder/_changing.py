# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders of changing meshes and particles, kept up to date."""

from __future__ import annotations

import dataclasses
import math
import threading
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arrays import integers
from ._arrays import points as as_points
from ._errors import InvalidArgument
from ._graphs import graph_arrays
from ._meshes import cell_arrays
from ._options import prepared, whole
from ._permutation import Permutation


@dataclasses.dataclass(frozen=True)
class Update:
    """Result of `Reorderer.update`.

    Attributes:
        permutation: from the present places of the rows; moves nothing if ``repair`` is "none".
        repair: how the order was found: "none"; "carried": present vertices keep their order, new ones come next to their
            neighbours or last; "warm": computed again from the last Fiedler vector; "fresh": computed again.
        reason: why a new order was computed or not, a sentence.
        span_log2: distance of neighbours: the mean of ⌊log₂ span⌋ over the edges of a sample of the vertices; for points
            alone, the mean of log₂ (1 + places away from the curve). Compare it only with values of the same method.
        fresh_span_log2: ``span_log2`` of the last order that was computed anew.
        added: number of new vertices.
        removed: number of vertices that are gone.
        seconds: wall-clock time of the call.
        complete: False if the budget or the time limit ended the search for a better order.
        notes: changes to a copy of the input: "12 loops dropped".
    """

    permutation: Permutation
    repair: str
    reason: str
    span_log2: float
    fresh_span_log2: float
    added: int
    removed: int
    seconds: float
    complete: bool
    notes: list[str]

    @property
    def old_to_new(self) -> NDArray[np.int32]:
        """The new place of each vertex."""
        return self.permutation.old_to_new

    @property
    def new_to_old(self) -> NDArray[np.int32]:
        """The vertex at each new place: ``points[update.new_to_old]`` are the moved points."""
        return self.permutation.new_to_old


class Reorderer:
    """Keeps the order of a changing mesh, graph or set of particles up to date.

    Call `update` whenever connectivity or positions have changed, and move all arrays by its permutation. Most updates only
    look at a sample, and nothing moves. A new order is computed when neighbours are too far apart, and now and then to test
    whether it would be better: first after 10 updates, then half as often after each test without a gain.

    Args:
        method: "auto", which chooses as `order` does for the first mesh, or the name of one of `methods`.
        slack: the share, ≥ 0, by which ``span_log2`` may exceed that of the last fresh order before a new one is computed;
            for points alone, ``span_log2`` may exceed it by ``slack`` · log₂ n.
        budget: seconds, ≥ 0: no new order is computed if the last one took longer; None: no limit.
        **options: see `Options`; but not ``progress``, ``start``, ``groups`` and ``cell_groups``.

    Raises:
        InvalidArgument: an unknown method, a negative slack or budget.
        TypeError: an unknown option, or one of the excluded ones.

    Example:
        A simulator that sometimes refines its mesh::

            reorderer = meshorder.Reorderer()
            while simulating:
                previous = refine(points, tetrahedra)   # the old place of each vertex, −1 for a new one
                update = reorderer.update({"tetra": tetrahedra}, points=points, previous=previous)
                points = update.permutation.move(points)
                tetrahedra = update.permutation.renumber(tetrahedra)
    """

    def __init__(
        self, method: str = "auto", *, slack: float = 0.02, budget: float | None = None, **options: Any
    ) -> None:
        for name in ("progress", "start", "groups", "cell_groups"):
            if name in options:
                raise TypeError(f"unexpected keyword argument {name!r}: it changes with the mesh")
        self._symmetric = bool(options.get("symmetric"))
        # one update at a time: the library runs without Python's lock
        self._lock = threading.Lock()
        with prepared(options) as given:
            self._inside = _core.Reorderer(method, float(slack), math.inf if budget is None else float(budget), given)

    def update(
        self, graph: Any = None, *, points: Any = None, previous: Any = None, vertex_count: int | None = None
    ) -> Update:
        """Brings the order up to date. Nothing is moved.

        Args:
            graph: a graph or matrix that `order` takes, in the present order of the arrays; or the cells of a mesh, as
                ``{type: array}`` or ``[(type, array), …]`` with meshio's names of types; or None if there are only points,
                such as particles. New vertices come next to their neighbours; by "hilbert" and "morton" the points of cells
                are sorted anew instead.
            points: one row of one to three coordinates for each vertex, or None.
            previous: the place of each vertex after the last update, no place twice, −1 for a new vertex; None: the same
                vertices in the same places.
            vertex_count: number of vertices of a mesh without points.

        Returns:
            The update; its ``permutation`` moves all values of vertices.

        Raises:
            InvalidArgument: a faulty graph, mesh or ``previous``; the object is then unchanged.
            TooLarge: 2³¹ or more vertices.
        """
        coordinates = None if points is None else as_points(points)
        places = None if previous is None else integers(previous, "previous")
        if isinstance(graph, dict) or (isinstance(graph, list) and all(isinstance(block, tuple) for block in graph)):
            if coordinates is None and vertex_count is None:
                raise InvalidArgument("update: without points vertex_count must be given")
            count = 0 if vertex_count is None else whole(vertex_count, 2**63 - 1, "vertex_count")
            cells = cell_arrays(graph, 3 if coordinates is None else coordinates.shape[1])
            with self._lock:
                made = self._inside.update_mesh(coordinates, cells, count, places)
        elif graph is not None:
            offsets, neighbours, _ = graph_arrays(graph, not self._symmetric)
            with self._lock:
                made = self._inside.update_graph(offsets, neighbours, coordinates, places)
        elif coordinates is not None:
            with self._lock:
                made = self._inside.update_points(coordinates, places)
        else:
            raise InvalidArgument("update: expected a graph, cells or points")
        made["permutation"] = Permutation._of(made["permutation"])
        return Update(**made)

    def observe(self, step_seconds: float) -> None:
        """Reports the duration of the step after the last update.

        From the fifth report on, a new order is computed once slower steps have lost more time than it costs. Optional.

        Args:
            step_seconds: ≥ 0 and finite.

        Raises:
            InvalidArgument: another time.
        """
        with self._lock:
            self._inside.observe(float(step_seconds))

    @property
    def state(self) -> bytes:
        """The state as bytes, for a checkpoint; `restore` continues from it."""
        with self._lock:
            state: bytes = self._inside.state()
            return state

    def restore(self, state: bytes) -> None:
        """Continues from a state of the same method.

        Args:
            state: a value of `state`.

        Raises:
            InvalidArgument: bytes that are not a whole state, or the state of another method; the object is then unchanged.
        """
        with self._lock:
            self._inside.restore(bytes(state))
