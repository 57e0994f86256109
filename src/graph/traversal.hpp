// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/level_search.hpp"

#include <memory>
#include <vector>

namespace meshorder {

/// Returns the vertices of each connected component, in ascending order. The largest component comes first,
/// ties by their smallest vertex, so that isolated vertices come last. O(edges · log n), nearly O(edges).
std::vector<std::vector<Index>> connected_components(GraphRef graph);

/// The number of connected components of a graph.
struct ComponentCounts {
  Index components = 0;
  Index isolated = 0;  ///< components of one vertex
};

/// Counts the components that `connected_components` would list, in the same time. Takes four bytes a vertex.
ComponentCounts component_counts(GraphRef graph);

/// A graph numbered by breadth-first searches, one from the smallest vertex of each component. Later searches
/// of this copy use the cache well. The rows list the same neighbours in the same order as those of the
/// original: a search visits the vertices of both graphs in the same order.
struct BreadthFirstCopy {
  /// A component: the vertices first … end − 1, level after level.
  struct Component {
    Index first;
    Index end;
    Index last_level;  ///< the first vertex of the last level
    Index depth;       ///< number of levels before the last
  };

  std::vector<Offset> offsets;
  std::unique_ptr<Index[]> neighbours;
  std::vector<Index> old_numbers;     ///< the old number of each vertex
  std::vector<Component> components;  ///< sorted as by `connected_components`

  [[nodiscard]] GraphRef graph() const { return {offsets, {neighbours.get(), std::size_t(offsets.back())}}; }
};

/// Returns the breadth-first copy of a graph. On all threads if there are more than two and the graph is
/// large. O(n + edges).
BreadthFirstCopy breadth_first_copy(GraphRef graph);

/// Returns the vertices of a component in breadth-first order from a vertex on the component's rim. Each
/// search starts at a vertex of least degree in the last level of the previous search (ties: smallest old
/// number), until the number of levels stops growing (Gibbs, Poole, Stockmeyer 1976, as simplified by George
/// and Liu 1979). The first search is the one that made the copy. O(searches · component), with few searches
/// in practice.
///
/// @param search  a search of the copy's graph; forgets the component before each new run
std::vector<Index> search_from_rim(const BreadthFirstCopy& copy, const BreadthFirstCopy::Component& component,
                                   LevelSearch& search);

}  // namespace meshorder
