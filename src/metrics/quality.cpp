// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "graph/clean_graph.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include <meshorder/error.hpp>
#include <meshorder/quality.hpp>

#include <algorithm>
#include <string>

namespace meshorder {

Quality quality_of(GraphRef graph, const Permutation& order) {
  const EdgeSpan span = edge_span(graph, order);
  return {.edges = graph.edge_count(),
          .mean_span = span.mean,
          .mean_log2_span = span.mean_log2,
          .bandwidth = span.max,
          .profile = profile(graph, order),
          .histogram_log2 = span_histogram_log2(graph, order),
          .jump_share = graph.edge_count() > 0 ? jump_share(graph, order) : 0};
}

inline namespace v0_3 {
namespace {

/// Calls `measure(graph, order)` with a clean graph and a permutation that fits it.
template <class Measure>
auto measured(const GraphView& graph, const Permutation* order, const Run& run, Symmetry symmetry,
              Measure measure) {
  return in_call(run, [&] {
    report("check");
    const GraphArrays clean = clean_graph(graph, Check::full, symmetry);
    if (order != nullptr && order->size() != clean.size()) {
      throw InvalidArgument("quality: an order of " + std::to_string(order->size()) + " places for " +
                            std::to_string(clean.size()) + " vertices");
    }
    const GraphRef arrays(clean.offsets, clean.neighbours);
    return order != nullptr ? measure(arrays, *order) : measure(arrays, Permutation::identity(clean.size()));
  });
}

}  // namespace

Quality quality(const GraphView& graph, const Run& run, Symmetry symmetry) {
  return measured(graph, nullptr, run, symmetry, quality_of);
}

Quality quality(const GraphView& graph, const Permutation& order, const Run& run, Symmetry symmetry) {
  return measured(graph, &order, run, symmetry, quality_of);
}

std::vector<Offset> span_histogram(const GraphView& graph, const Permutation& order, Index width,
                                   const Run& run) {
  return measured(graph, &order, run, Symmetry::require, [width](GraphRef clean, const Permutation& places) {
    return meshorder::span_histogram(clean, places, width);
  });
}

SparsityPattern sparsity_pattern(const GraphView& graph, const Permutation& order, int side, const Run& run,
                                 Symmetry symmetry) {
  if (side < 1) throw InvalidArgument("sparsity_pattern: a side of " + std::to_string(side) + " tiles");
  return measured(graph, &order, run, symmetry, [side](GraphRef clean, const Permutation& places) {
    return pattern_of(clean, places, side);
  });
}

}  // namespace v0_3

SparsityPattern pattern_of(GraphRef graph, const Permutation& order, int side) {
  SparsityPattern pattern;
  pattern.side = std::min(side, graph.size());
  const auto tile = [&](Index place) { return Offset{place} * pattern.side / graph.size(); };
  pattern.counts.resize(static_cast<std::size_t>(pattern.side) * pattern.side);
  for (Index v = 0; v < graph.size(); ++v) {
    const Index row = order.old_to_new()[v];
    const Offset first = tile(row) * pattern.side;
    ++pattern.counts[first + tile(row)];  // the diagonal entry
    for (const Index neighbour : graph[v]) ++pattern.counts[first + tile(order.old_to_new()[neighbour])];
  }
  return pattern;
}

}  // namespace meshorder
