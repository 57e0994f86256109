// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/graph_views.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/quality.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using testing::ElementsAre;

/// The same numbers by their definitions. Rows may be unsorted, with loops and repeated entries.
Quality by_definition(const CsrGraph& graph, const Permutation& order) {
  std::set<std::pair<Index, Index>> edges;  // pairs of places, the smaller place first
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) {
      if (u != v) edges.insert(std::minmax({order.old_to_new()[u], order.old_to_new()[v]}));
    }
  }
  Quality quality;
  std::vector<Index> first(static_cast<std::size_t>(graph.size()));
  for (Index place = 0; place < graph.size(); ++place) first[place] = place;
  for (const auto& [a, b] : edges) {
    const Index span = b - a;
    ++quality.edges;
    quality.mean_span += span;
    quality.mean_log2_span += std::log2(span);
    quality.bandwidth = std::max(quality.bandwidth, span);
    first[b] = std::min(first[b], a);
    std::size_t bin = 0;
    while ((Index{2} << bin) <= span) ++bin;
    if (quality.histogram_log2.size() <= bin) quality.histogram_log2.resize(bin + 1);
    ++quality.histogram_log2[bin];
  }
  for (Index place = 0; place < graph.size(); ++place) quality.profile += place - first[place];
  if (quality.edges > 0) {
    quality.mean_span /= static_cast<double>(quality.edges);
    quality.mean_log2_span /= static_cast<double>(quality.edges);
  }
  return quality;
}

void expect_same(const Quality& actual, const Quality& expected) {
  EXPECT_EQ(actual.edges, expected.edges);
  EXPECT_DOUBLE_EQ(actual.mean_span, expected.mean_span);
  EXPECT_NEAR(actual.mean_log2_span, expected.mean_log2_span, 1e-12);
  EXPECT_EQ(actual.bandwidth, expected.bandwidth);
  EXPECT_EQ(actual.profile, expected.profile);
  EXPECT_EQ(actual.histogram_log2, expected.histogram_log2);
}

TEST(Quality, OfAPathIsThatOfEdgesOfSpanOne) {
  const CsrGraph path = test::path(50);
  const Quality quality = meshorder::quality(test::view_of(path));
  EXPECT_EQ(quality, (Quality{.edges = 49,
                              .mean_span = 1,
                              .mean_log2_span = 0,
                              .bandwidth = 1,
                              .profile = 49,
                              .histogram_log2 = {49},
                              .jump_share = 1.0 / 7}));
}

TEST(Quality, OfAGridInRowsIsKnown) {
  constexpr Index kColumns = 8;
  constexpr Index kRows = 5;
  const CsrGraph grid = test::grid(kColumns, kRows);
  const Quality quality = meshorder::quality(test::view_of(grid));
  constexpr Offset kAlong = (kColumns - 1) * kRows;   // edges of span 1
  constexpr Offset kAcross = kColumns * (kRows - 1);  // edges of span 8
  EXPECT_EQ(quality.edges, kAlong + kAcross);
  EXPECT_DOUBLE_EQ(quality.mean_span, (kAlong + 8.0 * kAcross) / (kAlong + kAcross));
  EXPECT_DOUBLE_EQ(quality.mean_log2_span, 3.0 * kAcross / (kAlong + kAcross));
  EXPECT_EQ(quality.bandwidth, kColumns);
  // the first entry of a vertex is its neighbour above; in the first row its left neighbour, if it has one
  EXPECT_EQ(quality.profile, (kColumns - 1) + kColumns * kColumns * (kRows - 1));
  EXPECT_THAT(quality.histogram_log2, ElementsAre(kAlong, 0, 0, kAcross));
  EXPECT_THAT(span_histogram(test::view_of(grid), Permutation::identity(grid.size()), 3),
              ElementsAre(kAlong, 0, kAcross));
}

TEST(Quality, AgreesWithTheDefinitionsOnAnyGraph) {
  std::uint64_t seed = 1;
  for (const CsrGraph& graph : {test::star(40), test::complete(17), test::grid(6, 5, 4),
                                test::preferential_attachment(300, 2, 3), test::random_connected(400, 200, 5),
                                test::disjoint_union({test::path(1), test::cycle(9), test::path(3)})}) {
    const Permutation order = test::shuffled(graph.size(), ++seed);
    const Quality expected = by_definition(graph, order);
    for (const int threads : {1, 3}) {
      expect_same(quality(test::view_of(graph), order, {.threads = threads}), expected);
    }
    const test::CallersGraph<std::uint32_t, std::int64_t> callers(graph, 1);
    expect_same(quality(callers.view(), order), expected);
    const CsrGraph moved = renumbered(graph, order.old_to_new());
    EXPECT_EQ(quality(test::view_of(moved)), quality(test::view_of(graph), order));
    const std::vector<float> weights(graph.neighbours.size(), 2.5F);
    EXPECT_EQ(quality({graph.offsets, graph.neighbours, weights}, order),
              quality(test::view_of(graph), order));

    const std::vector<Offset> bins = span_histogram(test::view_of(graph), order, 1);
    ASSERT_EQ(bins.size(), static_cast<std::size_t>(expected.bandwidth) + 1);
    Offset edges = 0;
    Offset sum = 0;
    for (std::size_t span = 0; span < bins.size(); ++span) {
      edges += bins[span];
      sum += bins[span] * static_cast<Offset>(span);
    }
    EXPECT_EQ(edges, expected.edges);
    EXPECT_NEAR(static_cast<double>(sum), expected.mean_span * static_cast<double>(edges), 1e-6);
  }
}

TEST(Quality, CountsRepeatsOnceAndLoopsNever) {
  const CsrGraph messy{{0, 4, 6, 7}, {2, 0, 1, 1, 0, 0, 0}};
  const Permutation order = Permutation::from_old_to_new({1, 0, 2});
  expect_same(quality(test::view_of(messy), order), by_definition(messy, order));
  EXPECT_EQ(quality(test::view_of(messy)).edges, 2);
}

TEST(Quality, IsNothingWithoutEdges) {
  const std::vector<Offset> offsets(6, 0);
  EXPECT_EQ(quality({}), Quality{});
  const GraphView graph{offsets, {}};
  EXPECT_EQ(quality(graph), Quality{});
  EXPECT_TRUE(span_histogram(graph, Permutation::identity(5), 2).empty());
}

TEST(Quality, RefusesWhatDoesNotFit) {
  const CsrGraph path = test::path(4);
  EXPECT_THROW((void)quality(test::view_of(path), Permutation::identity(3)), InvalidArgument);
  EXPECT_THROW((void)span_histogram(test::view_of(path), Permutation::identity(3), 1), InvalidArgument);
  EXPECT_THROW((void)span_histogram(test::view_of(path), Permutation::identity(4), 0), InvalidArgument);
  const CsrGraph one_way{{0, 1, 1}, {1}};
  EXPECT_THROW((void)quality(test::view_of(one_way)), InvalidArgument);
  EXPECT_THROW((void)quality(test::view_of(path), {.threads = -2}), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
