// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Orders by levels of a breadth-first search from a vertex at the rim. Cuthill, McKee: Reducing the Bandwidth
// of Sparse Symmetric Matrices (1969); reversed after George (1971).
#include "base/run_scope.hpp"
#include "graph/row_access.hpp"
#include "graph/traversal.hpp"
#include "ordering/all_methods.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Sorts vertices by rising degree, those of one degree as they come.
void sort_by_degree(GraphRef graph, std::span<Index> vertices) {
  constexpr std::size_t kFew = 32;  // std::stable_sort asks for memory even to sort two
  const auto less = [&](Index a, Index b) { return graph.degree(a) < graph.degree(b); };
  if (vertices.size() > kFew) return std::stable_sort(vertices.begin(), vertices.end(), less);
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Index v = vertices[k];
    std::size_t place = k;
    for (; place > 0 && less(v, vertices[place - 1]); --place) vertices[place] = vertices[place - 1];
    vertices[place] = v;
  }
}

/// Orders the components of a graph one after the other by `place(near, start, places)`, which fills
/// `places`, but for the last one, with the vertices of the component of `start`, a vertex at its rim.
template <class Place>
Order by_components(GraphRef graph, const Place& place) {
  const BreadthFirstCopy copy = breadth_first_copy(graph);
  std::vector<Index> new_to_old(std::size_t(graph.size()) + 1);
  std::vector<Index> tried(graph.size(), -1);
  std::size_t placed = 0;
  for (const BreadthFirstCopy::Component& component : copy.components) {
    const Index start = pseudo_peripheral_vertex(copy, component, tried);
    const auto size = static_cast<std::size_t>(component.end - component.first);
    place(copy.graph(), start, std::span(new_to_old).subspan(placed, size + 1));
    placed += size;
  }
  new_to_old.resize(placed);
  for (Index& v : new_to_old) v = copy.old_numbers[v];
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace

Order bfs_vertices(const VertexInput& input, const OrderOptions&) {
  std::vector<Index> reached(input.graph.size(), -1);
  return by_components(input.graph, [&](GraphRef near, Index start, std::span<Index> places) {
    std::ranges::copy(breadth_first(near, start, reached, 0).order, places.begin());
  });
}

Order rcm_vertices(const VertexInput& input, const OrderOptions&) {
  std::vector<char> placed(input.graph.size(), 0);
  return by_components(input.graph, [&](GraphRef near, Index start, std::span<Index> places) {
    places[0] = start;
    placed[start] = 1;
    Index found = 1;
    for (Index k = 0; k < found; ++k) {
      poll_in_loop(k);
      prefetch_row(near, places.first(std::size_t(found)), k);
      const Index first = found;
      for (const Index u : near[places[k]]) {  // without a branch, as in breadth_first
        places[found] = u;
        found += placed[u] == 0 ? 1 : 0;
        placed[u] = 1;
      }
      sort_by_degree(near, places.subspan(first, found - first));
    }
    std::ranges::reverse(places.first(found));
  });
}

}  // namespace meshorder
