// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/level_search.hpp"

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

/// Numbers a graph anew by one search, on all threads. O(n + edges).
BreadthFirstCopy breadth_first_copy(GraphRef graph);

/// The vertices of a component in the order of a search from one that is far from the others: from its first
/// vertex, the search goes to a vertex of least degree in the last level until that adds no level (Gibbs,
/// Poole, Stockmeyer 1976, as simplified by George and Liu 1979); of several to that of the smallest old
/// number. O(searches · component), few searches in practice, of which the copy has made the first.
///
/// @param search  of the copy's graph; what it knows of the component is forgotten
std::vector<Index> search_from_rim(const BreadthFirstCopy& copy, const BreadthFirstCopy::Component& component,
                                   LevelSearch& search);

}  // namespace meshorder
