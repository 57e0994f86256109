// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/permutation.hpp>
#include <meshorder/quality.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace meshorder {

/// Statistics of the spans of edges in an order: the span of edge ij is |rank i − rank j| (the paper,
/// section 4.3). All 0 for a graph without edges.
struct EdgeSpan {
  double mean = 0;       ///< 1 at best; n/3 for a random order
  Index max = 0;         ///< the bandwidth of the matrix with this pattern
  double mean_log2 = 0;  ///< mean of log₂ span: emphasises near neighbours; the mean emphasises far ones

  bool operator==(const EdgeSpan&) const = default;
};

/// Returns the statistics of all edges' spans in the given order. O(n + edges).
EdgeSpan edge_span(GraphRef graph, const Permutation& order);

/// Like `edge_span`, for the edges at the vertices of a `VertexSample`, on all threads. On tetrahedral meshes
/// `mean` is within 5 % of the exact value and `mean_log2` within 0.05; `max` is at most the exact value.
/// Below 262,144 vertices all values are exact except for rounding. Values do not depend on the number of
/// threads. O(vertices and edges of the sample).
///
/// @param place_of  the new number of each vertex; empty: the vertices keep their numbers
EdgeSpan sampled_edge_span(GraphRef graph, std::span<const Index> place_of);

/// Sums over the entries of a graph; each edge has two entries.
template <class Number>
struct SpanSums {
  Number entries = 0;
  Number sum = 0;
  Number max = 0;
  double log2_sum = 0;

  SpanSums& operator+=(const SpanSums& other) {
    entries += other.entries;
    sum += other.sum;
    max = std::max(max, other.max);
    log2_sum += other.log2_sum;
    return *this;
  }
};

/// The sum and maximum of the spans of edges.
struct SpanSize {
  Offset sum = 0;
  Index max = 0;

  SpanSize& operator+=(const SpanSize& other);
};

/// Returns the sum and maximum of all edges' spans. Uses all threads; polls. `place_of` as in
/// `sampled_edge_span`. O(n + edges).
SpanSize span_size(GraphRef graph, std::span<const Index> place_of);

/// Like `edge_span`. From 262,144 vertices on it uses all threads, and `mean_log2` is the estimate of
/// `sampled_edge_span`. Does not depend on the number of threads. O(n + edges).
EdgeSpan quick_edge_span(GraphRef graph, std::span<const Index> place_of);

/// Returns the size of the envelope of a matrix with this pattern, without the diagonal: the sum of the
/// distances from each vertex to its first neighbour in the order, if this neighbour precedes the vertex.
/// O(n + edges).
Offset profile(GraphRef graph, const Permutation& order);

/// Returns all measures, as the public `quality` does. O(n + edges).
Quality quality_of(GraphRef graph, const Permutation& order);

/// Returns the number of edges with a span in [2^k, 2^(k+1)), for k from 0 to the last k with an edge.
/// O(n + edges).
std::vector<Offset> span_histogram_log2(GraphRef graph, const Permutation& order);

/// Returns the number of edges with a span in [k·width, (k + 1)·width), for k from 0 to the last k with an
/// edge (the paper's Figure 10 has a width of 50). Throws InvalidArgument unless `width` ≥ 1. O(n + edges).
std::vector<Offset> span_histogram(GraphRef graph, const Permutation& order, Index width);

}  // namespace meshorder
