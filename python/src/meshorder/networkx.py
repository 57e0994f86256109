# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Functions with names and signatures of networkx, also for its backend "meshorder"."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._graphs import Fiedler, fiedler, networkx_arrays

__all__ = ["algebraic_connectivity", "fiedler_vector", "spectral_ordering"]

_MOST_ITERATIONS = 2000


def _weights(graph: Any, weight: str | None) -> NDArray[np.float64] | None:
    """Returns the absolute weights of the edges, as networkx uses them, in the order of `networkx_arrays`; or None."""
    if weight is None and not graph.is_multigraph():
        return None
    rows = [row for _, row in graph.adjacency()]
    if graph.is_multigraph():
        parallel = itertools.chain.from_iterable(row.values() for row in rows)
        weights = [sum(abs(attributes.get(weight, 1)) for attributes in edges.values()) for edges in parallel]
    else:
        weights = [attributes.get(weight, 1) for row in rows for attributes in row.values()]
    return np.abs(np.array(weights, dtype=np.float64))


def _solved(graph: Any, weight: str | None, tol: float, seed: Any) -> Fiedler:
    """Returns the Fiedler vectors of an undirected graph.

    Raises networkx's exceptions for directed graphs, and if the eigensolver does not converge.
    """
    import networkx

    if graph.is_directed():
        raise networkx.NetworkXNotImplemented("not implemented for directed type")
    offsets, neighbours = networkx_arrays(graph)
    weights = _weights(graph, weight)
    if weights is not None and not weights.all():  # edges of weight 0 are left out
        kept = np.flatnonzero(weights)
        offsets, neighbours, weights = np.searchsorted(kept, offsets), neighbours[kept], weights[kept]
    start = int(seed) if isinstance(seed, (int, np.integer)) else 0
    solved = fiedler(
        (offsets, neighbours), weights=weights, tolerance=tol, seed=abs(start), max_iterations=_MOST_ITERATIONS
    )
    if not solved.converged:
        raise networkx.ExceededMaxIterations(
            f"the eigensolver did not reach the tolerance {tol:g} in {_MOST_ITERATIONS} iterations; a larger tol may do"
        )
    return solved


def _networkxs_own(name: str) -> Any:
    """Returns networkx's own implementation, whatever backend is selected."""
    import networkx

    return getattr(networkx, name).orig_func


def _connected(graph: Any) -> None:
    """Raises networkx's exception for graphs of fewer than two nodes."""
    import networkx

    if len(graph) < 2:
        raise networkx.NetworkXError("graph has less than two nodes.")


def fiedler_vector(
    G: Any, weight: str | None = "weight", normalized: bool = False, tol: float = 1e-8, method: str = "tracemin_pcg",
    seed: Any = None,
) -> NDArray[np.float64]:  # fmt: skip
    """Computes the Fiedler vector of a connected graph, as networkx.fiedler_vector does.

    Args:
        G: an undirected networkx graph.
        weight: the edge attribute with the weights; absolute values are used, and 1 if the attribute is missing;
            None: all weights are 1.
        normalized: True calls networkx's own function.
        tol: the residual ‖L x − λ x‖ relative to λ₂ ‖x‖.
        method: not used, except by networkx.
        seed: an integer for the eigensolver's start vector; other values, such as a RandomState, count as 0.

    Returns:
        One number for each node, in the order of ``G``'s nodes, with norm 1 and sum 0.

    Raises:
        networkx.NetworkXError: the graph has fewer than two nodes, or is not connected.
        networkx.NetworkXNotImplemented: the graph is directed.
        networkx.ExceededMaxIterations: the eigensolver does not reach ``tol`` in 2,000 iterations.
    """
    import networkx

    if normalized:
        return np.asarray(_networkxs_own("fiedler_vector")(G, weight, normalized, tol, method, seed))
    _connected(G)
    solved = _solved(G, weight, tol, seed)
    if len(solved.components) > 1:
        raise networkx.NetworkXError("graph is not connected.")
    return np.array(solved.values)


def algebraic_connectivity(
    G: Any, weight: str | None = "weight", normalized: bool = False, tol: float = 1e-8, method: str = "tracemin_pcg",
    seed: Any = None,
) -> float:  # fmt: skip
    """Computes the second-smallest eigenvalue of a graph's Laplacian, as networkx.algebraic_connectivity does.

    The arguments are those of `fiedler_vector`.

    Returns:
        The eigenvalue; 0.0 for a graph that is not connected.

    Raises:
        networkx.NetworkXError: the graph has fewer than two nodes.
        networkx.NetworkXNotImplemented: the graph is directed.
        networkx.ExceededMaxIterations: the eigensolver does not reach ``tol`` in 2,000 iterations.
    """
    if normalized:
        return float(_networkxs_own("algebraic_connectivity")(G, weight, normalized, tol, method, seed))
    _connected(G)
    solved = _solved(G, weight, tol, seed)
    return 0.0 if len(solved.components) > 1 else solved.lambda2


def spectral_ordering(
    G: Any, weight: str | None = "weight", normalized: bool = False, tol: float = 1e-8, method: str = "tracemin_pcg",
    seed: Any = None,
) -> list[Any]:  # fmt: skip
    """Sorts the nodes by their Fiedler vector, component after component, as networkx.spectral_ordering does.

    The arguments are those of `fiedler_vector`.

    Returns:
        All nodes in their new order, the components in the order of their first nodes.

    Raises:
        networkx.NetworkXError: the graph has no nodes.
        networkx.NetworkXNotImplemented: the graph is directed.
        networkx.ExceededMaxIterations: the eigensolver does not reach ``tol`` in 2,000 iterations.
    """
    import networkx

    if normalized:
        return list(_networkxs_own("spectral_ordering")(G, weight, normalized, tol, method, seed))
    if len(G) == 0:
        raise networkx.NetworkXError("graph is empty.")
    solved = _solved(G, weight, tol, seed)
    nodes = list(G)
    # components in the order of their first nodes, as networkx finds them
    first = np.full(len(solved.components), len(nodes))
    np.minimum.at(first, solved.component_of, np.arange(len(nodes)))
    places = np.lexsort((solved.values, first[solved.component_of]))
    return [nodes[place] for place in places]


class _Backend:
    """The functions that networkx calls for ``backend="meshorder"``. Graphs are not converted."""

    fiedler_vector = staticmethod(fiedler_vector)
    algebraic_connectivity = staticmethod(algebraic_connectivity)
    spectral_ordering = staticmethod(spectral_ordering)

    @staticmethod
    def convert_from_nx(graph: Any, *args: Any, **kwargs: Any) -> Any:
        return graph

    @staticmethod
    def convert_to_nx(result: Any, *, name: str | None = None) -> Any:
        return result

    @staticmethod
    def can_run(name: str, args: Any, kwargs: Any) -> bool:
        return not (kwargs.get("normalized") or (len(args) > 2 and args[2]))

    @staticmethod
    def should_run(name: str, args: Any, kwargs: Any) -> bool:
        return True


backend = _Backend()
