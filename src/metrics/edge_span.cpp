// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/edge_span.hpp"

#include "base/parallel.hpp"
#include "graph/vertex_sample.hpp"
#include <meshorder/error.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace meshorder {
namespace {

/// Calls `visit(span)` for every edge from a vertex of begin … end − 1 to a vertex with a smaller number.
///
/// @param place_of  `place_of(v)` returns the new number of a vertex
template <class PlaceOf, class Visit>
void for_each_span(GraphRef graph, PlaceOf place_of, Index begin, Index end, Visit visit) {
  for (Index v = begin; v < end; ++v) {
    const Index place = place_of(v);
    for (const Index u : graph[v]) {
      if (u < v) visit(std::abs(place_of(u) - place));
    }
  }
}

/// Calls `call(place)`, where `place(v)` returns the new number of a vertex. `place_of` as in
/// `sampled_edge_span`.
template <class Call>
auto with_places(std::span<const Index> place_of, Call call) {
  if (place_of.empty()) return call([](Index v) { return v; });
  return call([place_of](Index v) { return place_of[v]; });
}

/// Calls `visit(span)` for every edge once.
template <class Visit>
void for_each_span(GraphRef graph, std::span<const Index> place_of, Visit visit) {
  with_places(place_of, [&](auto place) { for_each_span(graph, place, 0, graph.size(), visit); });
}

/// Returns the number of edges in each bin, up to the last bin that has edges.
template <class BinOf>
std::vector<Offset> histogram(GraphRef graph, const Permutation& order, BinOf bin_of) {
  std::vector<Offset> bins;
  for_each_span(graph, order.old_to_new(), [&](Index span) {
    const auto bin = static_cast<std::size_t>(bin_of(span));
    if (bins.size() <= bin) bins.resize(bin + 1, 0);
    ++bins[bin];
  });
  return bins;
}

/// Returns the statistics of all edges' spans. `place_of` as in `sampled_edge_span`.
EdgeSpan exact_span(GraphRef graph, std::span<const Index> place_of) {
  EdgeSpan result;
  if (graph.neighbours.empty()) return result;
  // summed by span, not by edge: the result does not depend on the vertices' old numbers
  std::vector<Offset> edges_of_span(graph.size(), 0);
  for_each_span(graph, place_of, [&](Index span) { ++edges_of_span[span]; });
  double sum = 0;
  double log_sum = 0;
  for (Index span = 1; span < graph.size(); ++span) {
    if (edges_of_span[span] == 0) continue;
    const auto edges = static_cast<double>(edges_of_span[span]);
    sum += edges * span;
    log_sum += edges * std::log2(span);
    result.max = span;
  }
  const auto edges = static_cast<double>(graph.edge_count());
  result.mean = sum / edges;
  result.mean_log2 = log_sum / edges;
  return result;
}

/// @param place_of  `place_of(v)` returns the new number of a vertex
template <class PlaceOf>
EdgeSpan span_of_sample(GraphRef graph, PlaceOf place_of) {
  constexpr Index kAtOnce = 4096;  // vertices that a thread takes at a time
  constexpr Index kAhead = 8;
  constexpr double kLargeProduct = 0x1p+960;  // a smaller product times one more span does not overflow
  const VertexSample sample(graph.size());
  const auto sums = sum_over_chunks<SpanSums<Offset>>(sample.size(), kAtOnce, [&](Index begin, Index end) {
    SpanSums<Offset> part;
    double product = 1;  // one logarithm for many spans
    for (Index k = begin; k < end; ++k) {
      __builtin_prefetch(graph.neighbours.data() + graph.offsets[sample[std::min(k + kAhead, end - 1)]]);
      const Index v = sample[k];
      const Index place = place_of(v);
      for (const Index u : graph[v]) {
        const Index span = std::abs(place_of(u) - place);
        part.sum += span;
        part.max = std::max<Offset>(part.max, span);
        product *= span;
        if (product < kLargeProduct) continue;
        part.log2_sum += std::log2(product);
        product = 1;
      }
      part.entries += graph.degree(v);
    }
    part.log2_sum += std::log2(product);
    return part;
  });
  if (sums.entries == 0) return {};
  const auto entries = static_cast<double>(sums.entries);
  return {.mean = static_cast<double>(sums.sum) / entries,
          .max = static_cast<Index>(sums.max),
          .mean_log2 = sums.log2_sum / entries};
}

}  // namespace

EdgeSpan edge_span(GraphRef graph, const Permutation& order) { return exact_span(graph, order.old_to_new()); }

EdgeSpan sampled_edge_span(GraphRef graph, std::span<const Index> place_of) {
  return with_places(place_of, [&](auto place) { return span_of_sample(graph, place); });
}

SpanSize& SpanSize::operator+=(const SpanSize& other) {
  sum += other.sum;
  max = std::max(max, other.max);
  return *this;
}

SpanSize span_size(GraphRef graph, std::span<const Index> place_of) {
  constexpr Index kChunk = 4096;
  return with_places(place_of, [&](auto place) {
    return sum_over_chunks<SpanSize>(graph.size(), kChunk, [&](Index begin, Index end) {
      SpanSize size;
      for_each_span(graph, place, begin, end, [&](Index span) { size += {span, span}; });
      return size;
    });
  });
}

EdgeSpan quick_edge_span(GraphRef graph, std::span<const Index> place_of) {
  if (VertexSample(graph.size()).is_all() || graph.neighbours.empty()) return exact_span(graph, place_of);
  const SpanSize size = span_size(graph, place_of);
  return {.mean = static_cast<double>(size.sum) / static_cast<double>(graph.edge_count()),
          .max = size.max,
          .mean_log2 = sampled_edge_span(graph, place_of).mean_log2};
}

Offset profile(GraphRef graph, const Permutation& order) {
  Offset sum = 0;
  for (Index v = 0; v < graph.size(); ++v) {
    Index first = order.old_to_new()[v];
    for (const Index u : graph[v]) first = std::min(first, order.old_to_new()[u]);
    sum += order.old_to_new()[v] - first;
  }
  return sum;
}

std::vector<Offset> span_histogram_log2(GraphRef graph, const Permutation& order) {
  return histogram(graph, order,
                   [](Index span) { return std::bit_width(static_cast<std::uint32_t>(span)) - 1; });
}

std::vector<Offset> span_histogram(GraphRef graph, const Permutation& order, Index width) {
  if (width < 1) throw InvalidArgument("span histogram: bins without width");
  return histogram(graph, order, [width](Index span) { return span / width; });
}

}  // namespace meshorder
