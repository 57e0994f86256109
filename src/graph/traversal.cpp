// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/traversal.hpp"

#include "base/run_scope.hpp"
#include "graph/row_access.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace meshorder {

namespace {

/// A forest in which every vertex is below a smaller one of its component or the root of a tree.
class Forest {
 public:
  explicit Forest(Index vertices) : parents_(static_cast<std::size_t>(vertices)) {
    std::iota(parents_.begin(), parents_.end(), Index{0});
  }

  [[nodiscard]] Index parent(Index v) const { return parents_[v]; }

  void join(Index a, Index b) {
    const Index root = root_of(a);
    const Index other = root_of(b);
    parents_[std::max(root, other)] = std::min(root, other);
  }

 private:
  /// Halves the way on the way (Tarjan and van Leeuwen 1984).
  Index root_of(Index v) {
    while (parents_[v] != v) v = parents_[v] = parents_[parents_[v]];
    return v;
  }

  std::vector<Index> parents_;
};

/// Returns a tree for each component.
Forest forest_of(GraphRef graph) {
  Forest forest(graph.size());
  for (Index v = 0; v < graph.size(); ++v) {
    poll_in_loop(v);
    for (const Index u : graph[v]) {
      if (u < v) forest.join(u, v);
    }
  }
  return forest;
}

}  // namespace

ComponentCounts component_counts(GraphRef graph) {
  const Forest forest = forest_of(graph);
  ComponentCounts counts;
  for (Index v = 0; v < graph.size(); ++v) {
    counts.components += forest.parent(v) == v ? 1 : 0;
    counts.isolated += graph.degree(v) == 0 ? 1 : 0;
  }
  return counts;
}

std::vector<std::vector<Index>> connected_components(GraphRef graph) {
  const Forest forest = forest_of(graph);
  std::vector<std::vector<Index>> components;
  std::vector<Index> component_of(static_cast<std::size_t>(graph.size()));
  for (Index v = 0; v < graph.size(); ++v) {
    if (forest.parent(v) == v) components.emplace_back();
    component_of[v] = forest.parent(v) == v ? index_size(components) - 1 : component_of[forest.parent(v)];
    components[component_of[v]].push_back(v);
  }
  std::stable_sort(components.begin(), components.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return components;
}

// The searches below write down each neighbour and keep it if it is new, without a branch: whether a vertex
// has been found before is what a processor cannot predict.

BreadthFirst breadth_first(GraphRef graph, Index start, std::vector<Index>& marks, Index mark) {
  BreadthFirst search;
  std::vector<Index>& order = search.order;
  order.push_back(start);
  marks[start] = mark;
  Index found = 1;
  Index level_begin = 0;
  while (level_begin < found) {
    search.level_start.push_back(level_begin);
    const Index level_end = found;
    for (Index k = level_begin; k < level_end; ++k) {
      poll_in_loop(k);
      prefetch_row(graph, std::span(order).first(std::size_t(found)), k);
      const std::span<const Index> row = graph[order[k]];
      if (const std::size_t most = std::size_t(found) + row.size(); most > order.size()) {
        order.resize(std::max(most, 2 * order.size()));
      }
      for (const Index u : row) {
        order[found] = u;
        found += marks[u] != mark ? 1 : 0;
        marks[u] = mark;
      }
    }
    level_begin = level_end;
  }
  search.level_start.push_back(found);
  order.resize(found);
  return search;
}

BreadthFirstCopy breadth_first_copy(GraphRef graph) {
  const Index n = graph.size();
  BreadthFirstCopy copy;
  copy.offsets.reserve(std::size_t(n) + 1);
  copy.offsets.push_back(0);
  copy.neighbours.resize(graph.neighbours.size());
  copy.old_numbers.resize(std::size_t(n) + 1);
  std::vector<Index> number(n, -1);
  Index found = 0;
  Offset written = 0;
  for (Index v = 0; v < n; ++v) {
    if (number[v] >= 0) continue;
    const Index first = found;
    number[v] = found;
    copy.old_numbers[found++] = v;
    BreadthFirstCopy::Component component{.first = first, .end = 0, .last_level = first, .depth = 0};
    Index level_end = found;
    for (Index k = first; k < found; ++k) {
      poll_in_loop(k);
      if (k == level_end) {
        component.last_level = k;
        level_end = found;
        ++component.depth;
      }
      prefetch_row(graph, std::span(copy.old_numbers).first(std::size_t(found)), k);
      for (const Index u : graph[copy.old_numbers[k]]) {
        const bool is_new = number[u] < 0;
        copy.old_numbers[found] = u;
        number[u] = is_new ? found : number[u];
        copy.neighbours[written++] = number[u];
        found += is_new ? 1 : 0;
      }
      copy.offsets.push_back(written);
    }
    component.end = found;
    copy.components.push_back(component);
  }
  copy.old_numbers.resize(n);
  std::stable_sort(copy.components.begin(), copy.components.end(),
                   [](const auto& a, const auto& b) { return a.end - a.first > b.end - b.first; });
  return copy;
}

Index pseudo_peripheral_vertex(const BreadthFirstCopy& copy, const BreadthFirstCopy::Component& component,
                               std::vector<Index>& marks) {
  const GraphRef graph = copy.graph();
  Index start = component.first;
  Index depth = component.depth;
  std::vector<Index> last_level = index_range(component.last_level, component.end - component.last_level);
  for (Index mark = 0;; ++mark) {
    const Index candidate = *std::ranges::min_element(
        last_level, {}, [&](Index v) { return std::pair(graph.degree(v), copy.old_numbers[v]); });
    const BreadthFirst search = breadth_first(graph, candidate, marks, mark);
    if (search.depth() <= depth) return start;
    start = candidate;
    depth = search.depth();
    last_level.assign(search.order.begin() + search.level_start[depth], search.order.end());
  }
}

}  // namespace meshorder
