# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders, Fiedler vectors and the quality of orders, of graphs and matrices."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core, _html, _plots
from ._arrays import integers, reals
from ._arrays import points as as_points
from ._errors import InvalidArgument
from ._options import prepared
from ._permutation import Permutation


class FiedlerComponent(NamedTuple):
    """The eigensolver's report on a connected component."""

    size: int
    lambda2: float
    residual: float
    iterations: int
    converged: bool


@dataclass(frozen=True, eq=False, repr=False)
class Order:
    """An order and how it was found.

    Attributes:
        permutation: the new places.
        method: that made it; never "auto".
        reason: why "auto" took it; empty where it was asked for.
        fiedler: a report for each component, of methods that use Fiedler vectors.
        vector: of "fiedler" and "minla": the next call's ``start``; else None.
        complete: False if the time limit ended the method early.
        seconds: wall-clock time of the call.
        notes: what was cleaned or converted: "12 loops dropped".
    """

    permutation: Permutation
    method: str
    reason: str
    fiedler: list[FiedlerComponent]
    vector: NDArray[np.float64] | None
    complete: bool
    seconds: float
    notes: list[str]

    @classmethod
    def _of(cls, made: dict[str, Any]) -> Order:
        made["permutation"] = Permutation._of(made["permutation"])
        made["fiedler"] = [FiedlerComponent(*component) for component in made["fiedler"]]
        return cls(**made)

    @property
    def old_to_new(self) -> NDArray[np.int32]:
        """Of the permutation."""
        return self.permutation.old_to_new

    @property
    def new_to_old(self) -> NDArray[np.int32]:
        """Of the permutation."""
        return self.permutation.new_to_old

    def __repr__(self) -> str:
        n = len(self.permutation)
        return f"<Order of {n:,} by {self.method} in {self.seconds:.3g} s{'' if self.complete else ', incomplete'}>"

    def _repr_html_(self) -> str:
        return _html.order(self)

    def plot(self, graph: Any, *, side: int = 256, axes: Any = None) -> Any:
        """Draws the matrix's pattern before and after, by matplotlib. O(entries).

        Args:
            graph: that was ordered, as of `order`; must be symmetric.
            side: tiles along each side in which entries are counted.
            axes: two of matplotlib's; None: a new figure's.

        Returns:
            The two axes.

        Raises:
            ImportError: matplotlib is missing, which the extra ``plot`` brings.
        """
        offsets, neighbours = graph_arrays(graph)
        return _plots.patterns(self, offsets, neighbours, side, axes)


@dataclass(frozen=True, eq=False, repr=False)
class Fiedler:
    """The Fiedler vectors of all components of a graph.

    Attributes:
        values: in each component of norm 1 and sum 0; 0 for vertices without neighbours.
        components: a report for each, largest first.
        component_of: the component of each vertex.
        complete: False if the time limit ended the iteration.
        notes: what was cleaned.
    """

    values: NDArray[np.float64]
    component_of: NDArray[np.int32]
    components: list[FiedlerComponent]
    complete: bool
    notes: list[str]

    @property
    def lambda2(self) -> float:
        """The second-smallest eigenvalue of the largest component's Laplacian."""
        return self.components[0].lambda2 if self.components else 0.0

    @property
    def residual(self) -> float:
        """‖L x − λ x‖ / ‖x‖, the largest of all components."""
        return max((component.residual for component in self.components), default=0.0)

    @property
    def converged(self) -> bool:
        """Whether all components did."""
        return all(component.converged for component in self.components)

    def __repr__(self) -> str:
        parts = len(self.components)
        return (
            f"<Fiedler vector of {len(self.values):,} vertices, λ₂ = {self.lambda2:.6g}, residual {self.residual:.2g}"
            f"{f', {parts:,} components' if parts != 1 else ''}{'' if self.converged else ', not converged'}>"
        )

    def _repr_html_(self) -> str:
        return _html.fiedler(self)


@dataclass(frozen=True)
class Quality:
    """How near the ends of edges stand in an order. The span of an edge is the distance of its ends' places.

    Attributes:
        edges: loops not counted, repeats once.
        mean_span: about n/3 for a random order.
        mean_log2_span: mean of log₂ span.
        bandwidth: the largest span, the half bandwidth of the matrix.
        profile: sum over rows of the distance from the first neighbour before the diagonal to it.
        histogram_log2: entry k is the number of edges with a span of 2ᵏ … 2ᵏ⁺¹ − 1.
    """

    edges: int
    mean_span: float
    mean_log2_span: float
    bandwidth: int
    profile: int
    histogram_log2: list[int]

    def _repr_html_(self) -> str:
        return _html.quality(self)

    def plot(self, axes: Any = None) -> Any:
        """Draws the histogram of spans, by matplotlib.

        Args:
            axes: matplotlib's; None: a new figure's.

        Raises:
            ImportError: matplotlib is missing, which the extra ``plot`` brings.
        """
        return _plots.quality(self, axes)


def graph_arrays(graph: Any) -> tuple[NDArray[Any], NDArray[Any]]:
    """Offsets and neighbours of what users call a graph."""
    if hasattr(graph, "tocsr") and hasattr(graph, "nnz"):
        matrix = graph.tocsr()
        if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
            raise InvalidArgument(f"graph: a square matrix is needed, not one of shape {matrix.shape}")
        return integers(matrix.indptr, "indptr"), integers(matrix.indices, "indices")
    if hasattr(graph, "adjacency") and hasattr(graph, "number_of_nodes"):
        return networkx_arrays(graph)
    if hasattr(graph, "crow_indices"):
        return integers(graph.crow_indices(), "crow_indices"), integers(graph.col_indices(), "col_indices")
    if isinstance(graph, (tuple, list)) and len(graph) == 2:
        return integers(graph[0], "indptr"), integers(graph[1], "indices")
    raise InvalidArgument(
        f"graph: expected a SciPy matrix, (indptr, indices) or a networkx graph, not {type(graph).__name__}"
    )


def networkx_arrays(graph: Any) -> tuple[NDArray[Any], NDArray[Any]]:
    """Offsets and neighbours of a networkx graph, vertices in the order of its nodes."""
    place = {node: number for number, node in enumerate(graph)}
    rows = [neighbours for _, neighbours in graph.adjacency()]
    offsets = np.zeros(len(rows) + 1, dtype=np.int64)
    np.cumsum(np.fromiter(map(len, rows), dtype=np.int64, count=len(rows)), out=offsets[1:])
    entries = map(place.__getitem__, itertools.chain.from_iterable(rows))
    return offsets, np.fromiter(entries, dtype=np.int32, count=int(offsets[-1]))


def order_graph(graph: Any, method: str, points: Any, weights: Any, options: dict[str, Any]) -> Order:
    """`order`, of what is no mesh."""
    offsets, neighbours = graph_arrays(graph)
    given_weights = None if weights is None else reals(weights, "weights")
    coordinates = None if points is None else as_points(points)
    with prepared(options) as given:
        return Order._of(_core.order(offsets, neighbours, given_weights, coordinates, method, given))


def fiedler(graph: Any, *, weights: Any = None, tolerance: float = 1e-8, **options: Any) -> Fiedler:
    """The Fiedler vector of each component: the eigenvector of the Laplacian's second-smallest eigenvalue.

    Args:
        graph: as of `order`.
        weights: > 0, one for each entry.
        tolerance: ‖L x − λ x‖ ≤ tolerance · λ₂ ‖x‖.
        **options: see `Options`.
    """
    offsets, neighbours = graph_arrays(graph)
    given_weights = None if weights is None else reals(weights, "weights")
    with prepared({**options, "tolerance": tolerance}) as given:
        made = _core.fiedler(offsets, neighbours, given_weights, given)
    made["components"] = [FiedlerComponent(*component) for component in made["components"]]
    return Fiedler(**made)


def quality(graph: Any, order: Order | Permutation | None = None) -> Quality:
    """Measures the order that a graph's vertices have, or another one.

    Args:
        graph: as of `order`; must be symmetric.
        order: None: the order that the vertices have.
    """
    offsets, neighbours = graph_arrays(graph)
    permutation = order.permutation if isinstance(order, Order) else order
    made = _core.quality(offsets, neighbours, None if permutation is None else permutation._handle, {})
    return Quality(**made)
