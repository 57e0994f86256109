// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <vector>

namespace meshorder {

/// The vertices of each connected component, rising; components by falling size, ties by their smallest
/// vertex, so that isolated vertices come last. O(n + edges).
std::vector<std::vector<Index>> connected_components(GraphRef graph);

/// The vertices reached from `start` in breadth-first order, neighbours as their rows list them;
/// `level_start` marks where each level begins and ends with the number of vertices.
struct BreadthFirst {
  std::vector<Index> order;
  std::vector<Index> level_start;

  [[nodiscard]] Index depth() const noexcept { return index_size(level_start) - 2; }
};

/// Breadth-first search from one vertex over its component. `marks` needs one entry for each vertex; those
/// reached are set to `mark`, so that searches can share it without clearing. O(component).
BreadthFirst breadth_first(GraphRef graph, Index start, std::vector<Index>& marks, Index mark);

/// A vertex far from the others of its component: from `start`, the search goes to a vertex of least degree
/// in the last level until that adds no level (Gibbs, Poole, Stockmeyer 1976, as simplified by George and Liu
/// 1979). `marks` needs one entry for each vertex, −1 throughout the component, where it is changed; searches
/// of other components can share it. O(searches · component), few searches in practice.
Index pseudo_peripheral_vertex(GraphRef graph, Index start, std::vector<Index>& marks);

}  // namespace meshorder
