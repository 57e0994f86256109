// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Orders by levels of a breadth-first search from a vertex at the rim. Cuthill, McKee: Reducing the Bandwidth
// of Sparse Symmetric Matrices (1969); reversed after George (1971).
#include "base/run_scope.hpp"
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

/// Orders the components of a graph one after the other by `append(near, start, new_to_old)`, which appends
/// the vertices of the component of `start`, a vertex at its rim.
template <class Append>
Order by_components(GraphRef graph, const Append& append) {
  const BreadthFirstCopy copy = breadth_first_copy(graph);
  const GraphRef near = copy.graph();
  std::vector<Index> new_to_old;
  new_to_old.reserve(graph.size());
  std::vector<Index> tried(graph.size(), -1);
  for (const auto& [first, end] : copy.components) {
    append(near, pseudo_peripheral_vertex(near, first, tried, copy.old_numbers), new_to_old);
  }
  for (Index& v : new_to_old) v = copy.old_numbers[v];
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace

Order bfs_vertices(const VertexInput& input, const OrderOptions&) {
  std::vector<Index> placed(input.graph.size(), -1);
  return by_components(input.graph, [&](GraphRef near, Index start, std::vector<Index>& new_to_old) {
    const std::vector<Index> order = breadth_first(near, start, placed, 0).order;
    new_to_old.insert(new_to_old.end(), order.begin(), order.end());
  });
}

Order rcm_vertices(const VertexInput& input, const OrderOptions&) {
  std::vector<bool> placed(input.graph.size(), false);
  return by_components(input.graph, [&](GraphRef near, Index start, std::vector<Index>& new_to_old) {
    const std::size_t begin = new_to_old.size();
    new_to_old.push_back(start);
    placed[start] = true;
    for (std::size_t k = begin; k < new_to_old.size(); ++k) {
      poll_in_loop(k);
      const std::size_t found = new_to_old.size();
      for (const Index u : near[new_to_old[k]]) {
        if (placed[u]) continue;
        placed[u] = true;
        new_to_old.push_back(u);
      }
      sort_by_degree(near, std::span(new_to_old).subspan(found));
    }
    std::reverse(new_to_old.begin() + static_cast<std::ptrdiff_t>(begin), new_to_old.end());
  });
}

}  // namespace meshorder
