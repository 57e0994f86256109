// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "support/graph_orders.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace meshorder {
namespace {
using test::order_of;
using test::scrambled;

TEST(BreadthFirstOrders, PutAScrambledPathBackEndToEnd) {
  for (const Index n : {2, 3, 100, 5000}) {
    const CsrGraph path = scrambled(test::path(n), 1);
    EXPECT_EQ(edge_span(path, order_of(path, "rcm")), (EdgeSpan{1, 1, 0})) << n;
    EXPECT_EQ(edge_span(path, order_of(path, "bfs")), (EdgeSpan{1, 1, 0})) << n;
  }
}

TEST(BreadthFirstOrders, OfAGridHaveTheLeastBandwidthOrOneMore) {
  // the bandwidth of an a × b grid is its shorter side (Chvátalová 1975)
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const CsrGraph grid = scrambled(test::grid(40, 12), seed);
    EXPECT_LE(edge_span(grid, order_of(grid, "rcm")).max, 13);
    EXPECT_GE(edge_span(grid, order_of(grid, "rcm")).max, 12);
    EXPECT_LE(edge_span(grid, order_of(grid, "bfs")).max, 24);
  }
}

TEST(BreadthFirstOrders, RcmHasASmallerProfileThanItsReverse) {
  // George 1971: reversing Cuthill and McKee's order never makes the envelope larger
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const CsrGraph graph = test::random_connected(300, 200, seed);
    const Permutation rcm = order_of(graph, "rcm");
    std::vector<Index> sequence(rcm.new_to_old().begin(), rcm.new_to_old().end());
    std::reverse(sequence.begin(), sequence.end());
    EXPECT_LT(profile(graph, rcm), profile(graph, Permutation::from_new_to_old(sequence)));
  }
}

TEST(BreadthFirstOrders, RcmListsNeighboursByDegree) {
  // from the back: 0 at the rim, then 1, then its neighbours 4 (degree 1), 3 (degree 2) and 2 (degree 3)
  const std::vector<Edge> edges{{0, 1}, {1, 2}, {1, 3}, {1, 4}, {2, 3}, {2, 5}, {5, 6}};
  const CsrGraph graph = graph_from_edges(7, edges);
  std::vector<Index> sequence = order_of(graph, "rcm").new_to_old();
  if (sequence.back() != 6) {
    EXPECT_EQ(sequence, (std::vector<Index>{6, 5, 2, 3, 4, 1, 0}));
  } else {
    EXPECT_EQ(sequence, (std::vector<Index>{4, 0, 3, 1, 2, 5, 6}));
  }
}

TEST(BreadthFirstOrders, RcmListsManyNeighboursByDegree) {
  // a hub 0 with 50 neighbours, which have 0 to 6 leaves each
  constexpr Index kNeighbours = 50;
  std::vector<Edge> edges;
  Index n = kNeighbours + 1;
  for (Index v = 1; v <= kNeighbours; ++v) {
    edges.push_back({0, v});
    for (Index leaf = 0; leaf < v * 5 % 7; ++leaf) edges.push_back({v, n++});
  }
  const CsrGraph graph = graph_from_edges(n, edges);
  const Permutation order = order_of(graph, "rcm");
  std::vector<Index> degrees;  // of the neighbours in Cuthill and McKee's order
  for (Index k = n - 1; k >= 0; --k) {
    const Index v = order.new_to_old()[k];
    if (v >= 1 && v <= kNeighbours) degrees.push_back(graph.degree(v));
  }
  // the search begins at a leaf of the first
  EXPECT_TRUE(std::is_sorted(degrees.begin() + 1, degrees.end()));
}

TEST(BreadthFirstOrders, GoByLevelsFromOneEnd) {
  const CsrGraph graph = scrambled(test::grid(25, 10), 5);
  const Permutation order = order_of(graph, "bfs");
  // each vertex but the first has an earlier neighbour, and the first such neighbours never step back
  Index last = 0;
  for (Index k = 1; k < graph.size(); ++k) {
    Index first = graph.size();
    for (const Index u : graph[order.new_to_old()[k]]) first = std::min(first, order.old_to_new()[u]);
    ASSERT_LT(first, k);
    ASSERT_GE(first, last);
    last = first;
  }
}

TEST(BreadthFirstOrders, KeepComponentsTogetherLargestFirst) {
  const CsrGraph graph = test::disjoint_union({test::path(3), test::grid(5, 5), test::cycle(8)});
  for (const char* method : {"bfs", "rcm"}) {
    const std::vector<Index> sequence = order_of(graph, method).new_to_old();
    for (std::size_t k = 0; k < sequence.size(); ++k) {
      const Index v = sequence[k];
      EXPECT_EQ(k < 25 ? 0 : k < 33 ? 1 : 2, v >= 28 ? 1 : v >= 3 ? 0 : 2) << method << " at " << k;
    }
  }
}

}  // namespace
}  // namespace meshorder
