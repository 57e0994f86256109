// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/traversal.hpp"

#include "base/run_scope.hpp"

#include <algorithm>

namespace meshorder {

std::vector<std::vector<Index>> connected_components(GraphRef graph) {
  std::vector<std::vector<Index>> components;
  std::vector<bool> reached(graph.size(), false);
  for (Index start = 0; start < graph.size(); ++start) {
    if (reached[start]) continue;
    std::vector<Index> component{start};
    reached[start] = true;
    for (std::size_t k = 0; k < component.size(); ++k) {
      poll_in_loop(k);
      for (const Index u : graph[component[k]]) {
        if (reached[u]) continue;
        reached[u] = true;
        component.push_back(u);
      }
    }
    std::sort(component.begin(), component.end());
    components.push_back(std::move(component));
  }
  std::stable_sort(components.begin(), components.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return components;
}

BreadthFirst breadth_first(GraphRef graph, Index start, std::vector<Index>& marks, Index mark) {
  BreadthFirst search;
  search.order.push_back(start);
  marks[start] = mark;
  Index level_begin = 0;
  while (level_begin < index_size(search.order)) {
    search.level_start.push_back(level_begin);
    const Index level_end = index_size(search.order);
    for (Index k = level_begin; k < level_end; ++k) {
      poll_in_loop(k);
      for (const Index u : graph[search.order[k]]) {
        if (marks[u] == mark) continue;
        marks[u] = mark;
        search.order.push_back(u);
      }
    }
    level_begin = level_end;
  }
  search.level_start.push_back(index_size(search.order));
  return search;
}

Index pseudo_peripheral_vertex(GraphRef graph, Index start, std::vector<Index>& marks) {
  Index mark = 0;
  BreadthFirst search = breadth_first(graph, start, marks, mark);
  for (;;) {
    const auto last_level = search.order.begin() + search.level_start[search.depth()];
    const Index candidate = *std::min_element(last_level, search.order.end(), [&](Index a, Index b) {
      return graph.degree(a) != graph.degree(b) ? graph.degree(a) < graph.degree(b) : a < b;
    });
    BreadthFirst next = breadth_first(graph, candidate, marks, ++mark);
    if (next.depth() <= search.depth()) return search.order.front();
    search = std::move(next);
  }
}

}  // namespace meshorder
