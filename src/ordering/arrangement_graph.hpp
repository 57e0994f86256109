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

/// Returns where the middle of each vertex lies on the line, in half places, if the vertices lie side by side
/// in `order` (a list of all of them). O(n).
std::vector<Offset> middles(const ArrangementGraph& graph, const std::vector<Index>& order);

/// Returns Σ weight · distance of the middles over all edges, in half places: twice the sum of edge spans if
/// all volumes are 1. O(n + edges).
Offset total_span(const ArrangementGraph& graph, const std::vector<Index>& order);

/// A graph with fewer vertices, each of which is a group of vertices of a finer graph.
struct CoarseArrangement {
  ArrangementGraph graph;       ///< vertices numbered in the order of the first members of their groups
  std::vector<Index> group_of;  ///< for each vertex of the finer graph
};

/// Puts each vertex, in the given order, into the group of the neighbour with the largest weight over
/// distance on the line; a group has up to eight vertices. Groups hold near and strongly joined vertices, so
/// that the order of the groups fixes most of the order of the vertices. All edges between two groups become
/// one, with the sum of their weights. O(n + edges), deterministic.
CoarseArrangement coarsen(const ArrangementGraph& graph, const std::vector<Index>& order);

}  // namespace meshorder
