// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Orders by levels of a breadth-first search from a vertex at the rim. Cuthill, McKee: Reducing the Bandwidth
// of Sparse Symmetric Matrices (1969); reversed after George (1971).
#include "base/run_scope.hpp"
#include "graph/traversal.hpp"
#include "ordering/all_methods.hpp"

#include <algorithm>

namespace meshorder {

Order bfs_vertices(const VertexInput& input, const OrderOptions&) {
  std::vector<Index> new_to_old;
  new_to_old.reserve(input.graph.size());
  std::vector<Index> tried(input.graph.size(), -1);
  std::vector<Index> placed(input.graph.size(), -1);
  for (const std::vector<Index>& component : connected_components(input.graph)) {
    const Index start = pseudo_peripheral_vertex(input.graph, component.front(), tried);
    const std::vector<Index> order = breadth_first(input.graph, start, placed, 0).order;
    new_to_old.insert(new_to_old.end(), order.begin(), order.end());
  }
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

Order rcm_vertices(const VertexInput& input, const OrderOptions&) {
  const GraphRef graph = input.graph;
  std::vector<Index> new_to_old;
  new_to_old.reserve(graph.size());
  std::vector<Index> tried(graph.size(), -1);
  std::vector<bool> placed(graph.size(), false);
  for (const std::vector<Index>& component : connected_components(graph)) {
    const auto begin = new_to_old.size();
    const Index start = pseudo_peripheral_vertex(graph, component.front(), tried);
    new_to_old.push_back(start);
    placed[start] = true;
    for (auto k = begin; k < new_to_old.size(); ++k) {
      poll_in_loop(k);
      const auto found = static_cast<std::ptrdiff_t>(new_to_old.size());
      for (const Index u : graph[new_to_old[k]]) {
        if (placed[u]) continue;
        placed[u] = true;
        new_to_old.push_back(u);
      }
      std::stable_sort(new_to_old.begin() + found, new_to_old.end(),
                       [&](Index a, Index b) { return graph.degree(a) < graph.degree(b); });
    }
    std::reverse(new_to_old.begin() + static_cast<std::ptrdiff_t>(begin), new_to_old.end());
  }
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace meshorder
