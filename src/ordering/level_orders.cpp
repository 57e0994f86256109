// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Orders by levels of a breadth-first search from a vertex at the rim. Cuthill, McKee: Reducing the Bandwidth
// of Sparse Symmetric Matrices (1969); reversed after George (1971).
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "graph/level_search.hpp"
#include "graph/traversal.hpp"
#include "ordering/all_methods.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Sorts vertices by rising degree, stably.
void sort_by_degree(GraphRef graph, std::span<Index> vertices) {
  constexpr std::size_t kFew = 32;  // for more vertices use std::stable_sort, which allocates memory
  const auto less = [&](Index a, Index b) { return graph.degree(a) < graph.degree(b); };
  if (vertices.size() > kFew) return std::stable_sort(vertices.begin(), vertices.end(), less);
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Index v = vertices[k];
    std::size_t place = k;
    for (; place > 0 && less(v, vertices[place - 1]); --place) vertices[place] = vertices[place - 1];
    vertices[place] = v;
  }
}

/// Orders the components of a graph one after the other. `place(search, component, found, places)` fills
/// `places` with the vertices of a component. `found` has these vertices in breadth-first order from a vertex
/// at the rim.
template <class Place>
Order by_components(GraphRef graph, const Place& place) {
  const BreadthFirstCopy copy = breadth_first_copy(graph);
  LevelSearch search(copy.graph());
  std::vector<Index> new_to_old;
  resize_large(new_to_old, std::size_t(graph.size()));
  std::size_t placed = 0;
  for (const BreadthFirstCopy::Component& component : copy.components) {
    const std::vector<Index> found = search_from_rim(copy, component, search);
    place(search, component, found, std::span(new_to_old).subspan(placed, found.size()));
    placed += found.size();
  }
  constexpr Offset kAtOnce = 65536;
  for_each_range(graph.size(), kAtOnce, [&](Offset begin, Offset end) {
    for (Offset k = begin; k < end; ++k) new_to_old[k] = copy.old_numbers[new_to_old[k]];
  });
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace

Order bfs_vertices(const VertexInput& input, const OrderOptions&) {
  return by_components(input.graph,
                       [](LevelSearch&, const BreadthFirstCopy::Component&, std::span<const Index> found,
                          std::span<Index> places) { std::ranges::copy(found, places.begin()); });
}

Order rcm_vertices(const VertexInput& input, const OrderOptions&) {
  return by_components(input.graph, [](LevelSearch& search, const BreadthFirstCopy::Component& component,
                                       std::span<const Index> found, std::span<Index> places) {
    search.forget(component.first, component.end);
    search.run(found.front(), places, sort_by_degree);
    std::ranges::reverse(places);
  });
}

}  // namespace meshorder
