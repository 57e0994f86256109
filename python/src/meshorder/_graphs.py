# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders of graphs and matrices, Fiedler vectors, and the quality of orders."""

from __future__ import annotations

import itertools
import os
from dataclasses import dataclass
from typing import Any, NamedTuple, NoReturn

import numpy as np
from numpy.typing import NDArray

from . import _core, _html, _plots
from ._arrays import integers, reals
from ._arrays import points as as_points
from ._errors import InvalidArgument
from ._options import prepared
from ._permutation import Permutation


class FiedlerComponent(NamedTuple):
    """The eigensolver's report on a connected component.

    Attributes:
        size: number of vertices.
        lambda2: second-smallest eigenvalue of the component's Laplacian; 0 for a single vertex.
        residual: ‖L x − λ x‖ / ‖x‖, absolute.
        iterations: of LOBPCG on the component itself, without its coarser levels; 0 where a dense eigensolver was
            used.
        converged: whether the residual is at most ``tolerance · lambda2``.
    """

    size: int
    lambda2: float
    residual: float
    iterations: int
    converged: bool


@dataclass(frozen=True, eq=False, repr=False)
class Order:
    """An order of n vertices or cells, and a report on how it was found.

    Attributes:
        permutation: the new place of each vertex or cell.
        method: name of the method that made the order; never "auto".
        reason: why "auto" chose that method; empty if it was requested by name.
        fiedler: the eigensolver's report for each connected component, from methods that sort by a Fiedler vector
            ("fiedler", "minla", "fiedler-facet"); empty for others.
        vector: the Fiedler vector, n numbers, from the same methods: pass it as ``start`` to order a similar graph;
            None for others.
        complete: False if the time limit ended the method early.
        seconds: wall-clock time of the call.
        notes: changes to a copy of the input: "12 loops dropped", "offsets widened".
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
        """The new place of each old vertex or cell, as in ``numbers = order.old_to_new[numbers]``."""
        return self.permutation.old_to_new

    @property
    def new_to_old(self) -> NDArray[np.int32]:
        """The old place of the vertex or cell at each new place, as in ``a[order.new_to_old]``."""
        return self.permutation.new_to_old

    def __getattr__(self, name: str) -> NoReturn:
        if not name.startswith("_") and hasattr(Permutation, name):
            raise AttributeError(f"an Order has no {name!r}; use .permutation.{name}")
        raise AttributeError(f"'Order' object has no attribute {name!r}")

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NoReturn:
        self.permutation.__array__()

    def __repr__(self) -> str:
        n = len(self.permutation)
        return f"<Order of {n:,} by {self.method} in {self.seconds:.3g} s{'' if self.complete else ', incomplete'}>"

    def _repr_html_(self) -> str:
        return _html.order(self)

    def plot(self, graph: Any, *, side: int = 256, axes: Any = None) -> Any:
        """Draws the sparsity pattern of a matrix before and after the order, with matplotlib. O(entries).

        Args:
            graph: the graph or matrix that was ordered, in a form that `meshorder.order` takes, but not a mesh. An
                asymmetric pattern is drawn as that of A + Aᵀ.
            side: the entries are counted in side × side tiles, n × n if the matrix has fewer rows; ≥ 1.
            axes: two matplotlib Axes to draw on; None: those of a new figure.

        Returns:
            The two Axes.

        Raises:
            InvalidArgument: a graph of another size, ``side`` below 1.
            ImportError: matplotlib is not installed; the extra ``plot`` installs it.
        """
        offsets, neighbours, _ = graph_arrays(graph, mirror=True)
        return _plots.patterns(self, offsets, neighbours, side, axes)


@dataclass(frozen=True, eq=False, repr=False)
class Fiedler:
    """The Fiedler vectors of all connected components of a graph of n vertices.

    Attributes:
        values: n numbers: the Fiedler vector of each component at its vertices, with norm 1 and sum 0 within the
            component; 0 for vertices without neighbours. Signs are the same on every run.
        component_of: n numbers, the position of each vertex's component in ``components``.
        components: the eigensolver's report for each component, the largest component first.
        complete: False if the time limit ended the iteration.
        notes: changes to a copy of the graph: "12 loops dropped".
    """

    values: NDArray[np.float64]
    component_of: NDArray[np.int32]
    components: list[FiedlerComponent]
    complete: bool
    notes: list[str]

    @property
    def lambda2(self) -> float:
        """The second-smallest eigenvalue of the largest component's Laplacian; 0 for the graph without vertices."""
        return self.components[0].lambda2 if self.components else 0.0

    @property
    def residual(self) -> float:
        """The largest residual ‖L x − λ x‖ / ‖x‖ of all components, absolute."""
        return max((component.residual for component in self.components), default=0.0)

    @property
    def converged(self) -> bool:
        """Whether the eigensolver converged in all components."""
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
    """Measures of how near the two ends of edges are in an order of n vertices.

    The span of an edge is the distance between the places of its ends. All numbers are 0 for a graph without edges.

    Attributes:
        edges: number of edges, without loops; repeated entries count once.
        mean_span: mean of the spans: ≥ 1, about n/3 for a random order.
        mean_log2_span: mean of log₂ of the spans, on which a few long edges have little effect.
        bandwidth: the largest span: the half bandwidth of the matrix.
        profile: sum over the rows of the matrix of the distance from the diagonal to the first entry before it.
        histogram_log2: entry k is the number of edges with a span of 2ᵏ … 2ᵏ⁺¹ − 1.
        jump_share: share, 0 to 1, of the lines of 8 numbers whose first read in a product with the matrix is out of order.
            If vectors exceed the last cache, it explains the times of products in different orders.
    """

    edges: int
    mean_span: float
    mean_log2_span: float
    bandwidth: int
    profile: int
    histogram_log2: list[int]
    jump_share: float

    def _repr_html_(self) -> str:
        return _html.quality(self)

    def plot(self, axes: Any = None) -> Any:
        """Draws the histogram of spans with matplotlib.

        Args:
            axes: the matplotlib Axes to draw on; None: those of a new figure.

        Returns:
            The Axes.

        Raises:
            ImportError: matplotlib is not installed; the extra ``plot`` installs it.
        """
        return _plots.quality(self, axes)


def _is_of_scipy(given: Any) -> bool:
    return hasattr(given, "tocsr") and hasattr(given, "nnz")


def _is_of_networkx(given: Any) -> bool:
    return hasattr(given, "adjacency") and hasattr(given, "number_of_nodes")


def is_graph(given: Any) -> bool:
    """Returns whether an object is a SciPy matrix or a networkx graph."""
    return _is_of_scipy(given) or _is_of_networkx(given)


def graph_arrays(graph: Any, mirror: bool = False) -> tuple[NDArray[Any], NDArray[Any], Any]:
    """Returns the offsets and neighbours of a graph in one of the forms that `meshorder.order` takes.

    Args:
        graph: the graph.
        mirror: True: each directed edge of an edge_index counts in both directions.

    Returns:
        The two arrays, and for each entry the index of its weight among the given weights: an array, or a slice of all.

    Raises:
        InvalidArgument: none of these forms, a matrix that is not square, arrays that do not hold integers.
    """
    if _is_of_scipy(graph):
        matrix = graph.tocsr()
        if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
            raise InvalidArgument(f"graph: expected a square matrix, not one of shape {matrix.shape}")
        return integers(matrix.indptr, "indptr"), integers(matrix.indices, "indices"), slice(None)
    if _is_of_networkx(graph):
        return *networkx_arrays(graph), slice(None)
    if isinstance(graph, np.ndarray) and graph.ndim == 2 and len(graph) == 2:
        ends = integers(graph, "edge_index", rank=2).astype(np.int64)
        if ends.min(initial=0) < 0:
            raise InvalidArgument(f"edge_index: there is no node {ends.min()}")
        return compressed(ends, int(ends.max(initial=-1)) + 1, mirror)
    if isinstance(graph, (tuple, list)) and len(graph) == 2:
        return integers(graph[0], "indptr"), integers(graph[1], "indices"), slice(None)
    from .hosts import find_host  # here, because hosts imports this module

    host = find_host(graph)
    found = None if host is None else host.graph(mirror)
    if found is None:
        raise InvalidArgument(
            "graph: expected a SciPy matrix, (indptr, indices), a networkx graph, an edge_index of shape (2, E), or a sparse "
            f"matrix or Data of PyTorch, not {type(graph).__name__}{_remedy(graph)}"
        )
    return found


def _remedy(given: Any) -> str:
    """Returns a remedy for an object that is not a graph, or an empty text."""
    if isinstance(given, (str, os.PathLike)):
        return "; scipy.io.mmread(path).tocsr() reads a matrix"
    if not isinstance(given, np.ndarray) or given.ndim != 2:
        return ""
    if given.shape[1] == 2:
        return f" of shape {given.shape}; pass the transpose of an array of edges, .T"
    return f" of shape {given.shape}; scipy.sparse.csr_array makes a sparse matrix of a dense one"


def compressed(
    ends: NDArray[np.int64], count: int, mirror: bool
) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Returns the offsets and neighbours of a graph, and the place of each entry in ``ends``.

    Args:
        ends: the rows and columns of the entries.
        count: number of vertices.
        mirror: True: entries are taken in both directions.
    """
    rows, columns = np.concatenate([ends, ends[::-1]], axis=1) if mirror else ends
    places = np.argsort(rows * count + columns, kind="stable")
    offsets = np.zeros(count + 1, dtype=np.int64)
    np.cumsum(np.bincount(rows, minlength=count), out=offsets[1:])
    return offsets, columns[places].astype(np.int32), places


def _weights(weights: Any, places: Any) -> NDArray[Any] | None:
    """Returns weights in the order of the entries of `graph_arrays`."""
    if weights is None:
        return None
    if _is_of_scipy(weights):
        raise InvalidArgument("weights: expected a number for each entry, not a matrix; pass its .data")
    given = reals(weights, "weights")
    if not isinstance(places, slice) and len(given) != len(places):
        raise InvalidArgument(f"weights: expected {len(places)}, one for each entry, not {len(given)}")
    moved: NDArray[Any] = given[places]
    return moved


def networkx_arrays(graph: Any) -> tuple[NDArray[Any], NDArray[Any]]:
    """Returns the offsets and neighbours of a networkx graph, vertices in the order of its nodes."""
    place = {node: number for number, node in enumerate(graph)}
    rows = [neighbours for _, neighbours in graph.adjacency()]
    offsets = np.zeros(len(rows) + 1, dtype=np.int64)
    np.cumsum(np.fromiter(map(len, rows), dtype=np.int64, count=len(rows)), out=offsets[1:])
    entries = map(place.__getitem__, itertools.chain.from_iterable(rows))
    return offsets, np.fromiter(entries, dtype=np.int32, count=int(offsets[-1]))


def order_graph(graph: Any, method: str, points: Any, weights: Any, options: dict[str, Any]) -> Order:
    """Orders a graph or matrix; see `meshorder.order`."""
    offsets, neighbours, places = graph_arrays(graph)
    given_weights = _weights(weights, places)
    if not isinstance(method, str):
        raise InvalidArgument(f"method: expected the name of one of meshorder.methods(), not {method!r}")
    coordinates = None if points is None else as_points(points)
    with prepared(options) as given:
        return Order._of(_core.order(offsets, neighbours, given_weights, coordinates, method, given))


def fiedler(graph: Any, *, weights: Any = None, tolerance: float = 1e-8, **options: Any) -> Fiedler:
    """Computes the Fiedler vector of each connected component of a graph.

    It is the eigenvector of the second-smallest eigenvalue λ₂ of the Laplacian L = D − W, where W has the weight of
    each edge and D the sums of its rows.

    Args:
        graph: a graph or matrix in a form that `order` takes, but not a mesh. A matrix gives its pattern only; to use its
            values, pass them as weights.
        weights: one for each entry of the graph, in the order of its arrays, > 0, finite, and equal in both entries of
            an edge; None: all are 1.
        tolerance: > 0: iterates until ‖L x − λ x‖ ≤ tolerance · λ₂ ‖x‖.
        **options: see `Options`; ``workload``, ``groups`` and ``cell_groups`` have no effect.

    Returns:
        The vectors and a report for each component. A component that has not converged after ``max_iterations`` keeps
        its best vector, with ``converged`` False; that is not an error.

    Raises:
        InvalidArgument: a faulty graph, weights that are not positive, sizes that do not match.
        TooLarge: 2³¹ or more vertices.
        Stopped: ``progress`` returned False.

    Example:
        >>> path = [0, 1, 3, 5, 6], [1, 0, 2, 1, 3, 2]      # the graph 0–1–2–3
        >>> round(meshorder.fiedler(path).lambda2, 6)
        0.585786
    """
    offsets, neighbours, places = graph_arrays(graph)
    given_weights = _weights(weights, places)
    with prepared({**options, "tolerance": tolerance}) as given:
        made = _core.fiedler(offsets, neighbours, given_weights, given)
    made["components"] = [FiedlerComponent(*component) for component in made["components"]]
    return Fiedler(**made)


def quality(graph: Any, order: Order | Permutation | None = None) -> Quality:
    """Measures how near the ends of edges are in the present order of a graph's vertices, or in another one. O(entries).

    Args:
        graph: a graph or matrix in a form that `order` takes, but not a mesh. An asymmetric pattern counts as that of
            A + Aᵀ, so that edges of an edge_index or Data count in both directions.
        order: the order to measure; nothing is moved. None: the present order.

    Returns:
        Spans, bandwidth and profile.

    Raises:
        InvalidArgument: a faulty graph, an order of another size, an order that is neither `Order` nor `Permutation`.

    Example:
        >>> star = [0, 1, 2, 3, 6], [3, 3, 3, 0, 1, 2]
        >>> meshorder.quality(star).bandwidth
        3
        >>> meshorder.quality(star, meshorder.Permutation(new_to_old=[0, 3, 1, 2])).bandwidth
        2
    """
    offsets, neighbours, _ = graph_arrays(graph, mirror=True)
    permutation = order.permutation if isinstance(order, Order) else order
    if permutation is not None and not isinstance(permutation, Permutation):
        raise InvalidArgument(
            f"order: expected an Order or Permutation, not {type(order).__name__}; Permutation(new_to_old=array) makes one"
        )
    made = _core.quality(offsets, neighbours, None if permutation is None else permutation._handle, {})
    return Quality(**made)
