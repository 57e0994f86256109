# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders of meshes and particles that change, kept fresh."""

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
    """What `Reorderer.update` found.

    Attributes:
        permutation: from the places that the arrays have now; moves nothing where ``repair`` is "none".
        repair: how the order came about: "none"; "carried": what was there keeps its order, what is new comes next to its
            neighbours; "warm": computed anew from the last Fiedler vector; "fresh": computed anew.
        reason: why there is a new order, or none; a sentence.
        span_log2: how near neighbours are: the mean of ⌊log₂ span⌋ over the edges of a sample of the vertices; of points
            alone the mean of log₂ (1 + places away from the curve). To be compared for one method only.
        fresh_span_log2: the same of the last order that was computed anew.
        added: number of new vertices.
        removed: number of vertices that are gone.
        seconds: wall-clock time of the call.
        complete: False: the budget or the time limit kept a better order from being found.
        notes: what was cleaned or converted.
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
    """Keeps the order of a mesh, graph or set of particles fresh while it changes.

    Call `update` whenever connectivity or positions have changed, and move all arrays by its permutation. Most updates look
    at a sample, and nothing moves. A new order comes when neighbours are too far apart, and now and then to see whether it
    would be better: at first after 10 updates, and twice as rarely whenever that was in vain.

    Args:
        method: "auto", which takes what `order` would take for the first mesh, or the name of one of `methods`.
        slack: the share, ≥ 0, by which ``span_log2`` may exceed that of the last fresh order.
        budget: seconds, ≥ 0: no order is computed anew that took longer the last time; None: no limit.
        **options: see `Options`; not ``progress``, ``start``, ``groups`` and ``cell_groups``.

    Raises:
        InvalidArgument: an unknown method, a slack or budget that is negative.
        TypeError: an unknown option, or one of those that are not taken.

    Example:
        A simulator whose mesh is refined at times::

            reorderer = meshorder.Reorderer()
            while simulating:
                previous = refine(points, tetrahedra)   # the place of each vertex before, −1 where it is new
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
            graph: a graph or matrix as `order` takes it, in the places that the arrays have now; or the cells of a mesh, as
                ``{type: array}`` or ``[(type, array), …]`` with meshio's names of types; or None, where there are points
                alone, such as particles.
            points: one row of one to three coordinates for each vertex, or None.
            previous: for each vertex its place after the last update, −1 for a new one, each at most once; None: the same
                vertices in the same places.
            vertex_count: of a mesh without points.

        Returns:
            The update, whose ``permutation`` moves all that belongs to vertices.

        Raises:
            InvalidArgument: a faulty graph, mesh or ``previous``; the object is unchanged then.
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
        """Reports how long the step took that followed the last update.

        From the fifth report on a new order comes when the time that slower steps lose exceeds its cost. Optional.

        Args:
            step_seconds: ≥ 0 and finite.

        Raises:
            InvalidArgument: another time.
        """
        with self._lock:
            self._inside.observe(float(step_seconds))

    @property
    def state(self) -> bytes:
        """The state as bytes, for a checkpoint: `restore` continues from it."""
        with self._lock:
            state: bytes = self._inside.state()
            return state

    def restore(self, state: bytes) -> None:
        """Continues from a state of the same method.

        Args:
            state: bytes that `state` gave.

        Raises:
            InvalidArgument: bytes that are no whole state, or one of another method; the object is unchanged then.
        """
        with self._lock:
            self._inside.restore(bytes(state))
