// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Orders by levels of a breadth-first search from a vertex at the rim. Cuthill, McKee: Reducing the Bandwidth
// of Sparse Symmetric Matrices (1969); reversed after George (1971).
#include "graph/traversal.hpp"
#include "ordering/all_methods.hpp"

#include <algorithm>

namespace meshorder {

Ordering bfs_vertices(const VertexProblem& problem, const OrderingOptions&) {
  std::vector<Index> new_to_old;
  new_to_old.reserve(problem.graph.size());
  std::vector<Index> tried(problem.graph.size(), -1);
  std::vector<Index> placed(problem.graph.size(), -1);
  for (const std::vector<Index>& component : connected_components(problem.graph)) {
    const Index start = pseudo_peripheral_vertex(problem.graph, component.front(), tried);
    const std::vector<Index> order = breadth_first(problem.graph, start, placed, 0).order;
    new_to_old.insert(new_to_old.end(), order.begin(), order.end());
  }
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

Ordering rcm_vertices(const VertexProblem& problem, const OrderingOptions&) {
  const GraphRef graph = problem.graph;
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
