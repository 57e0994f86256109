# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Functions with the names and signatures of networkx's, and the backend that networkx finds them by."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._graphs import Fiedler, fiedler, networkx_arrays

__all__ = ["algebraic_connectivity", "fiedler_vector", "spectral_ordering"]


def _weights(graph: Any, weight: str | None) -> NDArray[np.float64] | None:
    """The edges' weights in the order of `networkx_arrays`, without their signs as networkx takes them; or None."""
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
    import networkx

    if graph.is_directed():
        raise networkx.NetworkXNotImplemented("not implemented for directed type")
    offsets, neighbours = networkx_arrays(graph)
    weights = _weights(graph, weight)
    if weights is not None and not weights.all():  # an edge of weight 0 is none
        kept = np.flatnonzero(weights)
        offsets, neighbours, weights = np.searchsorted(kept, offsets), neighbours[kept], weights[kept]
    start = int(seed) if isinstance(seed, (int, np.integer)) else 0
    return fiedler(
        (offsets, neighbours), weights=weights, tolerance=tol, seed=abs(start), max_iterations=2000
    )


def _networkxs_own(name: str) -> Any:
    """networkx's own implementation, whatever backend is in force."""
    import networkx

    return getattr(networkx, name).orig_func


def _connected(graph: Any) -> None:
    import networkx

    if len(graph) < 2:
        raise networkx.NetworkXError("graph has less than two nodes.")


def fiedler_vector(
    G: Any, weight: str | None = "weight", normalized: bool = False, tol: float = 1e-8, method: str = "tracemin_pcg",
    seed: Any = None,
) -> NDArray[np.float64]:  # fmt: skip
    """As networkx.fiedler_vector. ``normalized=True`` is left to networkx; ``method`` is not used."""
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
    """As networkx.algebraic_connectivity. ``normalized=True`` is left to networkx; ``method`` is not used."""
    if normalized:
        return float(_networkxs_own("algebraic_connectivity")(G, weight, normalized, tol, method, seed))
    _connected(G)
    solved = _solved(G, weight, tol, seed)
    return 0.0 if len(solved.components) > 1 else solved.lambda2


def spectral_ordering(
    G: Any, weight: str | None = "weight", normalized: bool = False, tol: float = 1e-8, method: str = "tracemin_pcg",
    seed: Any = None,
) -> list[Any]:  # fmt: skip
    """As networkx.spectral_ordering: the nodes by their Fiedler vector, component by component."""
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
    """What networkx calls where ``backend="meshorder"`` is asked for. Graphs stay networkx's own."""

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
