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

BreadthFirstCopy breadth_first_copy(GraphRef graph) {
  constexpr Index kAhead = 8;  // rows lie anywhere in memory and are asked for early
  const Index n = graph.size();
  BreadthFirstCopy copy;
  copy.offsets.reserve(std::size_t(n) + 1);
  copy.offsets.push_back(0);
  copy.neighbours.reserve(graph.neighbours.size());
  copy.old_numbers.reserve(n);
  std::vector<Index> number(n, -1);
  const auto find = [&](Index v) {
    number[v] = index_size(copy.old_numbers);
    copy.old_numbers.push_back(v);
  };
  for (Index v = 0; v < n; ++v) {
    if (number[v] >= 0) continue;
    const Index first = index_size(copy.old_numbers);
    find(v);
    for (Index k = first; k < index_size(copy.old_numbers); ++k) {
      poll_in_loop(k);
      if (k + kAhead < index_size(copy.old_numbers)) {
        __builtin_prefetch(graph.neighbours.data() + graph.offsets[copy.old_numbers[k + kAhead]]);
      }
      for (const Index u : graph[copy.old_numbers[k]]) {
        if (number[u] < 0) find(u);
        copy.neighbours.push_back(number[u]);
      }
      copy.offsets.push_back(static_cast<Offset>(copy.neighbours.size()));
    }
    copy.components.emplace_back(first, index_size(copy.old_numbers));
  }
  std::stable_sort(copy.components.begin(), copy.components.end(),
                   [](const auto& a, const auto& b) { return a.second - a.first > b.second - b.first; });
  return copy;
}

Index pseudo_peripheral_vertex(GraphRef graph, Index start, std::vector<Index>& marks,
                               std::span<const Index> names) {
  const auto name = [&](Index v) { return names.empty() ? v : names[v]; };
  Index mark = 0;
  BreadthFirst search = breadth_first(graph, start, marks, mark);
  for (;;) {
    const auto last_level = search.order.begin() + search.level_start[search.depth()];
    const Index candidate = *std::min_element(last_level, search.order.end(), [&](Index a, Index b) {
      return graph.degree(a) != graph.degree(b) ? graph.degree(a) < graph.degree(b) : name(a) < name(b);
    });
    BreadthFirst next = breadth_first(graph, candidate, marks, ++mark);
    if (next.depth() <= search.depth()) return search.order.front();
    search = std::move(next);
  }
}

}  // namespace meshorder
