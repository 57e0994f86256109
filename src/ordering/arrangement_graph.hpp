// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <vector>

namespace meshorder {

/// A graph whose vertices may represent several vertices of a finer one, and whose edges may represent
/// several edges. A multilevel search for a linear arrangement works on such graphs.
struct ArrangementGraph {
  std::vector<Offset> offsets{0};  ///< n + 1; rows as in CsrGraph, but not sorted
  std::vector<Index> neighbours;
  std::vector<Offset> weights;  ///< one for each neighbour, above 0; empty when all are 1
  std::vector<Index> volumes;   ///< n: the places on the line that each vertex takes up, above 0

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] Offset weight(Offset k) const { return weights.empty() ? 1 : weights[k]; }
};

/// Returns the middle of each vertex on the line, in half places. The vertices lie side by side in `order`, a
/// list of all vertices. O(n).
std::vector<Offset> middles(const ArrangementGraph& graph, const std::vector<Index>& order);

/// Returns Σ weight · distance of the middles over all edges, in half places: twice the sum of edge spans if
/// all volumes are 1. O(n + edges).
Offset total_span(const ArrangementGraph& graph, const std::vector<Index>& order);

/// A graph with fewer vertices, each of which is a group of vertices of a finer graph.
struct CoarseArrangement {
  ArrangementGraph graph;       ///< its vertices are numbered in the order of their groups' first members
  std::vector<Index> group_of;  ///< group of each vertex of the finer graph
};

/// Puts each vertex, in the given order, into the group of the neighbour with the largest ratio of edge
/// weight to distance on the line. A group has up to eight vertices. Groups hold near and strongly joined
/// vertices, so that the order of the groups fixes most of the order of the vertices. All edges between two
/// groups become one, with the sum of their weights. O(n + edges), deterministic.
CoarseArrangement coarsen(const ArrangementGraph& graph, const std::vector<Index>& order);

/// Improves an order by local search: takes out each vertex in turn and puts it back where the total span is
/// least. Makes `passes` passes, or fewer if no vertex moves any more. Returns the total span of the result.
///
/// Changes are computed exactly: when a vertex slides past the next vertex on the line, only the spans of
/// edges at these two vertices change, by a known sum. Each step of a slide therefore takes O(1) time. A
/// slide ends when the span has risen so far above its least value that a better place is rare, or after a
/// number of steps proportional to the vertex's edges.
///
/// Works on chunks of the order, on all threads. Vertices stay in their chunk; each chunk of the next pass
/// overlaps two chunks of this pass. The result does not depend on the number of threads. O(n + edges) a
/// pass.
Offset improve_by_insertions(const ArrangementGraph& graph, std::vector<Index>& order, int passes);

}  // namespace meshorder
