// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/edge_span.hpp"

#include "base/parallel.hpp"
#include "graph/vertex_sample.hpp"
#include "ordering/method.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

/// The span of every edge once, by looking at all pairs.
std::vector<Index> all_spans(const CsrGraph& graph, const Permutation& order) {
  std::vector<Index> spans;
  for (Index a = 0; a < graph.size(); ++a) {
    for (Index b = a + 1; b < graph.size(); ++b) {
      const auto row = graph[a];
      if (std::find(row.begin(), row.end(), b) == row.end()) continue;
      spans.push_back(std::abs(order.old_to_new()[a] - order.old_to_new()[b]));
    }
  }
  return spans;
}

TEST(EdgeSpan, IsThatOfAllPairs) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const CsrGraph graph = test::random_connected(120, 300, seed);
    const Permutation order = test::shuffled(120, seed + 10);
    const std::vector<Index> spans = all_spans(graph, order);
    const auto edges = static_cast<double>(spans.size());
    double logs = 0;
    for (const Index span : spans) logs += std::log2(span);
    const EdgeSpan found = edge_span(graph, order);
    EXPECT_DOUBLE_EQ(found.mean, std::accumulate(spans.begin(), spans.end(), 0.0) / edges);
    EXPECT_EQ(found.max, *std::max_element(spans.begin(), spans.end()));
    EXPECT_NEAR(found.mean_log2, logs / edges, 1e-12);
    const SpanSize size = span_size(graph, order.old_to_new());
    EXPECT_EQ(size.sum, std::accumulate(spans.begin(), spans.end(), Offset{0}));
    EXPECT_EQ(size.max, found.max);
  }
}

/// Coordinates of the test grid's vertices, which `test::grid` numbers along x first.
std::vector<Point> points_of_grid(Index side) {
  std::vector<Point> points;
  for (Index v = 0; v < side * side * side; ++v)
    points.push_back({1.0 * (v % side), 1.0 * (v / side % side), 1.0 * (v / side / side)});
  return points;
}

TEST(SampledEdgeSpan, OfAFewVerticesIsExact) {
  const CsrGraph graph = test::grid(40, 30, 20);
  const Permutation order = test::shuffled(graph.size(), 1);
  const EdgeSpan exact = edge_span(graph, order);
  const EdgeSpan found = sampled_edge_span(graph, order.old_to_new());
  EXPECT_EQ(found.mean, exact.mean);
  EXPECT_EQ(found.max, exact.max);
  EXPECT_NEAR(found.mean_log2, exact.mean_log2, 1e-12);
  const EdgeSpan as_it_is = sampled_edge_span(graph, {});
  EXPECT_EQ(as_it_is.mean, edge_span(graph, Permutation::identity(graph.size())).mean);
  EXPECT_EQ(sampled_edge_span(graph_from_edges(5, {}), {}), EdgeSpan{});
  EXPECT_EQ(sampled_edge_span(CsrGraph{}, {}), EdgeSpan{});
}

TEST(QuickEdgeSpan, OfAFewVerticesIsExact) {
  const CsrGraph graph = test::grid(40, 30, 20);
  const Permutation order = test::shuffled(graph.size(), 1);
  EXPECT_EQ(quick_edge_span(graph, order.old_to_new()), edge_span(graph, order));
  EXPECT_EQ(quick_edge_span(graph, {}), edge_span(graph, Permutation::identity(graph.size())));
}

TEST(QuickEdgeSpan, HasTheExactMeanAndMaximumAndALogarithmNearby) {
  const CsrGraph graph = test::grid(81, 81, 81);
  for (const Permutation& order : {Permutation::identity(graph.size()), test::shuffled(graph.size(), 1)}) {
    const EdgeSpan exact = edge_span(graph, order);
    const EdgeSpan found = quick_edge_span(graph, order.old_to_new());
    EXPECT_DOUBLE_EQ(found.mean, exact.mean);
    EXPECT_EQ(found.max, exact.max);
    EXPECT_NEAR(found.mean_log2, exact.mean_log2, 0.05);
  }
  EXPECT_EQ(quick_edge_span(graph, {}),
            quick_edge_span(graph, Permutation::identity(graph.size()).old_to_new()));
  EXPECT_EQ(quick_edge_span(CsrGraph{}, {}), EdgeSpan{});
}

TEST(SampledEdgeSpan, OfManyVerticesIsNearAndTheSameOnAnyNumberOfThreads) {
  // 64 divides the steps of the sample, 81 does not
  for (const Index side : {64, 81}) {
    const CsrGraph graph = test::grid(side, side, side);
    const Permutation rows = Permutation::identity(graph.size());
    const Permutation hilbert = order_graph("hilbert", {graph, points_of_grid(side)}).permutation;
    const Permutation scattered = test::shuffled(graph.size(), 2);
    for (const Permutation* const order : {&rows, &hilbert, &scattered}) {
      const EdgeSpan exact = edge_span(graph, *order);
      const auto on_threads = [&](int threads) {
        return in_arena({.threads = threads}, [&] { return sampled_edge_span(graph, order->old_to_new()); });
      };
      const EdgeSpan found = on_threads(1);
      EXPECT_NEAR(found.mean, exact.mean, 0.05 * exact.mean);
      EXPECT_NEAR(found.mean_log2, exact.mean_log2, 0.05);
      EXPECT_LE(found.max, exact.max);
      EXPECT_NE(found.mean, exact.mean) << "is a sample";
      EXPECT_EQ(on_threads(8), found);
      EXPECT_EQ(sampled_edge_span(graph, {}) == found, order == &rows);
    }
  }
}

TEST(VertexSample, TakesOneVertexOfEachBlock) {
  for (const Index n : {0, 1, 262143, 262144, 300001, kMaxIndex}) {
    const VertexSample sample(n);
    EXPECT_EQ(sample.is_all(), n < 262144);
    EXPECT_LE(sample.size(), 262144);
    EXPECT_GE(sample.size(), std::min(n, 131072));
    const Index block = sample.is_all() ? 1 : std::bit_floor(static_cast<std::uint32_t>(n)) >> 17U;
    for (Index k = 0; k < sample.size(); ++k) ASSERT_EQ(sample[k] / block, k) << n;
    EXPECT_TRUE(n == 0 || sample[sample.size() - 1] < n);
  }
}

TEST(EdgeSpan, SizeAddsUpAllChunks) {
  const Index n = 10000;
  const SpanSize size = span_size(test::path(n), {});
  EXPECT_EQ(size.sum, n - 1);
  EXPECT_EQ(size.max, 1);
}

TEST(EdgeSpan, OfAPathIsOneInOrder) {
  EXPECT_EQ(edge_span(test::path(50), Permutation::identity(50)), (EdgeSpan{1, 1, 0}));
  std::vector<Index> reversed(50);
  for (Index v = 0; v < 50; ++v) reversed[v] = 49 - v;
  EXPECT_EQ(edge_span(test::path(50), Permutation::from_old_to_new(reversed)), (EdgeSpan{1, 1, 0}));
}

TEST(EdgeSpan, OfACompleteGraphIsAThirdInEveryOrder) {
  const Index n = 31;
  const CsrGraph complete = test::complete(n);
  const EdgeSpan in_order = edge_span(complete, Permutation::identity(n));
  EXPECT_DOUBLE_EQ(in_order.mean, (n + 1) / 3.0);
  EXPECT_EQ(in_order.max, n - 1);
  const EdgeSpan shuffled = edge_span(complete, test::shuffled(n, 1));
  EXPECT_DOUBLE_EQ(shuffled.mean, in_order.mean);
  EXPECT_NEAR(shuffled.mean_log2, in_order.mean_log2, 1e-12);
}

TEST(EdgeSpan, OfAGridInRowsIsTheMeanOfOneAndARow) {
  const EdgeSpan span = edge_span(test::grid(20, 10), Permutation::identity(200));
  EXPECT_DOUBLE_EQ(span.mean, (10 * 19 * 1 + 20 * 9 * 20) / (10.0 * 19 + 20 * 9));
  EXPECT_EQ(span.max, 20);
}

TEST(EdgeSpan, OfNoEdgesIsZero) {
  EXPECT_EQ(edge_span(CsrGraph{}, Permutation()), EdgeSpan{});
  EXPECT_EQ(edge_span(graph_from_edges(5, {}), Permutation::identity(5)), EdgeSpan{});
  EXPECT_EQ(profile(graph_from_edges(5, {}), Permutation::identity(5)), 0);
  EXPECT_TRUE(span_histogram_log2(CsrGraph{}, Permutation()).empty());
}

TEST(Profile, IsThatOfTheDenseMatrix) {
  const CsrGraph graph = test::random_connected(90, 120, 4);
  const Permutation order = test::shuffled(90, 5);
  const CsrGraph matrix = renumbered(graph, order.old_to_new());
  Offset expected = 0;
  for (Index row = 0; row < 90; ++row) {
    for (Index column = 0; column < row; ++column) {
      const auto entries = matrix[row];
      if (std::find(entries.begin(), entries.end(), column) == entries.end()) continue;
      expected += row - column;
      break;
    }
  }
  EXPECT_EQ(profile(graph, order), expected);
}

TEST(Profile, OfPathStarAndCompleteGraph) {
  EXPECT_EQ(profile(test::path(40), Permutation::identity(40)), 39);
  EXPECT_EQ(profile(test::complete(40), Permutation::identity(40)), 40 * 39 / 2);
  EXPECT_EQ(profile(test::star(40), Permutation::identity(40)), 40 * 39 / 2);
  std::vector<Index> centre_last(40);
  for (Index v = 0; v < 40; ++v) centre_last[v] = v == 0 ? 39 : v - 1;
  EXPECT_EQ(profile(test::star(40), Permutation::from_old_to_new(centre_last)), 39);
}

TEST(SpanHistogram, HoldsEveryEdgeInItsBin) {
  const CsrGraph graph = test::random_connected(150, 400, 6);
  const Permutation order = test::shuffled(150, 7);
  const std::vector<Offset> bins = span_histogram_log2(graph, order);
  EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), Offset{0}), graph.edge_count());
  const std::vector<Index> spans = all_spans(graph, order);
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const auto in_bin = std::count_if(spans.begin(), spans.end(),
                                      [&](Index span) { return span >= 1 << k && span < 2 << k; });
    EXPECT_EQ(bins[k], in_bin) << "bin " << k;
  }
  EXPECT_GT(bins.back(), 0);
}

TEST(SpanHistogram, PutsPowersOfTwoIntoTheirOwnBin) {
  const std::vector<Edge> edges{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 7}, {0, 8}};
  EXPECT_EQ(span_histogram_log2(graph_from_edges(9, edges), Permutation::identity(9)),
            (std::vector<Offset>{1, 2, 2, 1}));
}

TEST(SpanHistogram, HasBinsOfTheWidthAskedFor) {
  const CsrGraph graph = test::random_connected(150, 400, 6);
  const Permutation order = test::shuffled(150, 7);
  const std::vector<Index> spans = all_spans(graph, order);
  for (const Index width : {1, 50, 1000}) {
    const std::vector<Offset> bins = span_histogram(graph, order, width);
    EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), Offset{0}), graph.edge_count());
    EXPECT_GT(bins.back(), 0);
    for (Index k = 0; k < index_size(bins); ++k) {
      const auto in_bin = std::count_if(spans.begin(), spans.end(), [&](Index span) {
        return span >= k * width && span <= (k + 1) * width - 1;
      });
      EXPECT_EQ(bins[k], in_bin) << "bin " << k;
    }
  }
}

TEST(SpanHistogram, NeedsBinsOfSomeWidth) {
  EXPECT_THROW(span_histogram(test::path(4), Permutation::identity(4), 0), InvalidArgument);
  EXPECT_TRUE(span_histogram(CsrGraph{}, Permutation::identity(0), 50).empty());
}

}  // namespace
}  // namespace meshorder
