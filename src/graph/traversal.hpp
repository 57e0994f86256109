// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <vector>

namespace meshorder {

/// The vertices of each connected component, rising; components by falling size, ties by their smallest
/// vertex, so that isolated vertices come last. O(edges · log n), nearly O(edges).
std::vector<std::vector<Index>> connected_components(GraphRef graph);

/// How many connected components a graph has.
struct ComponentCounts {
  Index components = 0;
  Index isolated = 0;  ///< of them, those of one vertex
};

/// Counts as `connected_components` would find them, in four bytes for each vertex. As fast.
ComponentCounts component_counts(GraphRef graph);

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

/// A graph whose vertices are numbered as a breadth-first search from the smallest vertex of each component
/// finds them, so that further searches find in the cache what they look at. Rows list the same neighbours in
/// the same order as before: a search passes through both graphs alike.
struct BreadthFirstCopy {
  /// A component's vertices, first … end − 1, level after level.
  struct Component {
    Index first;
    Index end;
    Index last_level;  ///< the first vertex of the last level
    Index depth;       ///< how many levels come before that one
  };

  std::vector<Offset> offsets;
  std::vector<Index> neighbours;
  std::vector<Index> old_numbers;     ///< of each vertex
  std::vector<Component> components;  ///< in the order of `connected_components`

  [[nodiscard]] GraphRef graph() const { return {offsets, neighbours}; }
};

/// Numbers a graph anew by one search, which reads each row once. O(n + edges).
BreadthFirstCopy breadth_first_copy(GraphRef graph);

/// A vertex far from the others of a component: from its first vertex, the search goes to a vertex of least
/// degree in the last level until that adds no level (Gibbs, Poole, Stockmeyer 1976, as simplified by George
/// and Liu 1979); of several to that of the smallest old number. `marks` needs one entry for each vertex, −1
/// throughout the component, where it is changed; searches of other components can share it. O(searches ·
/// component), few searches in practice, of which the copy has made the first.
Index pseudo_peripheral_vertex(const BreadthFirstCopy& copy, const BreadthFirstCopy::Component& component,
                               std::vector<Index>& marks);

}  // namespace meshorder
