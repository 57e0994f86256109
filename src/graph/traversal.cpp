// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/traversal.hpp"

#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "graph/row_access.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

namespace meshorder {

namespace {

/// A forest: the parent of each vertex is a smaller vertex of its component, or the vertex itself if it is a
/// root.
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
  /// Returns the root of a tree and halves the path to it (Tarjan and van Leeuwen 1984).
  Index root_of(Index v) {
    while (parents_[v] != v) v = parents_[v] = parents_[parents_[v]];
    return v;
  }

  std::vector<Index> parents_;
};

/// Returns a forest with one tree for each component.
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

namespace {

/// Returns an uninitialised array. The system clears each page when a thread first writes to the page.
std::unique_ptr<Index[]> unfilled_array(std::size_t size) {
  std::unique_ptr<Index[]> array = std::make_unique_for_overwrite<Index[]>(size);
  ask_for_large_pages(array.get(), size * sizeof(Index));
  return array;
}

/// Makes the copy in one pass: copies each row when the search visits the row's vertex.
BreadthFirstCopy copy_in_one_pass(GraphRef graph) {
  const Index n = graph.size();
  BreadthFirstCopy copy;
  reserve_large(copy.offsets, std::size_t(n) + 1);
  copy.offsets.push_back(0);
  copy.neighbours = unfilled_array(graph.neighbours.size());
  resize_large(copy.old_numbers, std::size_t(n) + 1);
  std::vector<Index> number;
  reserve_large(number, std::size_t(n));
  number.resize(n, -1);
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
      prefetch_row(graph, std::span(copy.old_numbers).first(std::size_t(found)), k, number.data());
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
  return copy;
}

/// Makes the copy in two passes on all threads: searches, then copies the rows.
BreadthFirstCopy copy_on_threads(GraphRef graph) {
  const auto n = static_cast<std::size_t>(graph.size());
  BreadthFirstCopy copy;
  resize_large(copy.old_numbers, n);
  LevelSearch search(graph);
  Index found = 0;
  for (Index v = 0; v < graph.size(); ++v) {
    poll_in_loop(v);
    if (search.has_found(v)) continue;
    const Index end = search.run(v, copy.old_numbers, nullptr, found);
    copy.components.push_back({.first = found,
                               .end = end,
                               .last_level = search.level_start()[search.depth()],
                               .depth = search.depth()});
    found = end;
  }
  resize_large(copy.offsets, n + 1);
  constexpr Index kRowsAtOnce = 4096;
  for_each_chunk(graph.size(), kRowsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index k = begin; k < end; ++k) copy.offsets[k + 1] = graph.degree(copy.old_numbers[k]);
  });
  std::partial_sum(copy.offsets.begin(), copy.offsets.end(), copy.offsets.begin());
  copy.neighbours = unfilled_array(graph.neighbours.size());
  const std::span<const Index> number = search.place_of();
  for_each_chunk(graph.size(), kRowsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      prefetch_row(graph, copy.old_numbers, k, number.data());
      Index* place = copy.neighbours.get() + copy.offsets[k];
      for (const Index u : graph[copy.old_numbers[k]]) *place++ = number[u];
    }
  });
  return copy;
}

}  // namespace

BreadthFirstCopy breadth_first_copy(GraphRef graph) {
  constexpr Index kSmall = 1 << 15;
  constexpr Index kFew = 2;  // with so few threads, one pass is faster than two
  const bool is_shared = thread_count() > kFew && graph.size() >= kSmall;
  BreadthFirstCopy copy = is_shared ? copy_on_threads(graph) : copy_in_one_pass(graph);
  std::stable_sort(copy.components.begin(), copy.components.end(),
                   [](const auto& a, const auto& b) { return a.end - a.first > b.end - b.first; });
  return copy;
}

std::vector<Index> search_from_rim(const BreadthFirstCopy& copy, const BreadthFirstCopy::Component& component,
                                   LevelSearch& search) {
  const Index size = component.end - component.first;
  // begin with the order of the search that made the copy
  std::vector<Index> order = index_range(component.first, size);
  std::vector<Index> next;
  resize_large(next, static_cast<std::size_t>(size));
  Index depth = component.depth;
  std::span<const Index> last_level = std::span(order).subspan(component.last_level - component.first);
  while (true) {
    const Index candidate = *std::ranges::min_element(
        last_level, {}, [&](Index v) { return std::pair(copy.graph().degree(v), copy.old_numbers[v]); });
    search.forget(component.first, component.end);
    search.run(candidate, next);
    if (search.depth() <= depth) break;
    depth = search.depth();
    order.swap(next);
    last_level = std::span(order).subspan(search.level_start()[depth], size - search.level_start()[depth]);
  }
  return order;
}

}  // namespace meshorder
