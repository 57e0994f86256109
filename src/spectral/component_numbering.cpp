// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/component_numbering.hpp"

#include "base/resize_in_steps.hpp"
#include "base/run_scope.hpp"

#include <algorithm>
#include <array>

namespace meshorder {
namespace {

constexpr Index kUnseen = -1;
constexpr Index kFound = -2;    // seen, not yet numbered
constexpr Index kBatch = 256;   // vertices whose discoveries are sorted together
constexpr Index kDegrees = 64;  // larger degrees are rare and sorted as this one

/// Asks for the row that stands a few places after `k` in the order: rows lie anywhere in memory.
void prefetch_row(GraphRef graph, std::span<const Index> order, Index k) {
  constexpr Index kAhead = 8;
  if (k + kAhead < index_size(order)) {
    __builtin_prefetch(graph.neighbours.data() + graph.offsets[order[k + kAhead]]);
  }
}

/// Appends the vertices to the order by rising degree, those of one degree as they come, and numbers them.
void append_by_degree(GraphRef graph, const std::vector<Index>& found, Index component_start,
                      ComponentNumbering& numbering, Index& tail) {
  const auto degree = [&](Index v) { return std::min(graph.degree(v), kDegrees); };
  std::array<Index, std::size_t{kDegrees} + 2> place{};
  for (const Index v : found) ++place[degree(v) + 1];
  for (std::size_t d = 1; d < place.size(); ++d) place[d] += place[d - 1];
  for (const Index v : found) {
    const Index at = tail + place[degree(v)]++;
    numbering.order[at] = v;
    numbering.number[v] = at - component_start;
  }
  tail += index_size(found);
}

/// Numbers the component of `start` from order[tail] on.
void number_component(GraphRef graph, Index start, std::vector<Index>& found, ComponentNumbering& numbering,
                      Index& tail) {
  const Index component_start = tail;
  numbering.order[tail++] = start;
  numbering.number[start] = 0;
  for (Index head = component_start; head < tail;) {
    poll();
    const Index batch_end = std::min(tail, head + kBatch);
    found.clear();
    for (; head < batch_end; ++head) {
      prefetch_row(graph, {numbering.order.data(), numbering.order.data() + tail}, head);
      for (const Index u : graph[numbering.order[head]]) {
        if (numbering.number[u] != kUnseen) continue;
        numbering.number[u] = kFound;
        found.push_back(u);
      }
    }
    append_by_degree(graph, found, component_start, numbering, tail);
  }
}

}  // namespace

ComponentNumbering number_components(GraphRef graph) {
  const Index n = graph.size();
  ComponentNumbering numbering;
  numbering.order.resize(n);
  numbering.number.assign(n, kUnseen);
  std::vector<Index> found;
  Index tail = 0;
  for (Index v = 0; v < n; ++v) {
    if (numbering.number[v] != kUnseen) continue;
    number_component(graph, v, found, numbering, tail);
    numbering.starts.push_back(tail);
  }
  return numbering;
}

Laplacian component_laplacian(GraphRef graph, std::span<const double> weights,
                              const ComponentNumbering& numbering, Index c) {
  constexpr Index kRows = 4096;
  const auto vertices = numbering.component(c);
  const auto n = index_size(vertices);
  Laplacian result;
  result.offsets.resize(Offset{n} + 1);
  for (Index k = 0; k < n; ++k) result.offsets[k + 1] = result.offsets[k] + graph.degree(vertices[k]);
  result.diagonal.resize(n);
  resize_in_steps(result.neighbours, result.offsets[n]);
  if (!weights.empty()) result.weights.resize(result.offsets[n]);
  for_each_chunk(n, kRows, [&](Index, Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      prefetch_row(graph, vertices, k);
      const Index v = vertices[k];
      std::transform(graph[v].begin(), graph[v].end(), result.neighbours.begin() + result.offsets[k],
                     [&](Index u) { return numbering.number[u]; });
      result.diagonal[k] = graph.degree(v);
      if (weights.empty()) continue;
      const auto row = weights.subspan(graph.offsets[v], graph.degree(v));
      std::copy(row.begin(), row.end(), result.weights.begin() + result.offsets[k]);
      result.diagonal[k] = 0;
      for (const double weight : row) result.diagonal[k] += weight;
    }
  });
  return result;
}

}  // namespace meshorder
