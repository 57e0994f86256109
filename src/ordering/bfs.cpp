// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/breadth_first.hpp"
#include "graph/components.hpp"
#include "ordering/all_methods.hpp"

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

}  // namespace meshorder
