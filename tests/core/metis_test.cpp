// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include "ordering/method.hpp"
#include "support/graph_orders.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {
using test::order_of;

CsrGraph scrambled_mesh_graph() {
  const CsrGraph graph = vertex_graph(make_grid({12, 0.15, 0}));
  return renumbered(graph, test::shuffled(graph.size(), 1).old_to_new());
}

TEST(Metis, IsDeterministicAndSeeded) {
  const CsrGraph graph = scrambled_mesh_graph();
  for (const char* method : {"metis-nd", "metis-rb"}) {
    EXPECT_EQ(order_of(graph, method, 3), order_of(graph, method, 3)) << method;
    EXPECT_NE(order_of(graph, method, 3), order_of(graph, method, 4)) << method;
  }
}

TEST(Metis, BringsNeighboursTogether) {
  const CsrGraph graph = scrambled_mesh_graph();
  const EdgeSpan before = edge_span(graph, Permutation::identity(graph.size()));
  const EdgeSpan nd = edge_span(graph, order_of(graph, "metis-nd"));
  const EdgeSpan rb = edge_span(graph, order_of(graph, "metis-rb"));
  EXPECT_LT(nd.mean, 0.5 * before.mean);
  EXPECT_LT(rb.mean, 0.3 * before.mean);
  EXPECT_LT(rb.mean_log2, before.mean_log2 - 3);
}

TEST(Metis, NestedDissectionFillsLittle) {
  const CsrGraph grid = test::grid(25, 25);
  const CsrGraph graph = renumbered(grid, test::shuffled(grid.size(), 2).old_to_new());
  // by rows the factor of a 25 × 25 grid has about 25³ entries; the inverse of the order fills like a random
  // one
  EXPECT_LT(factor_entries(graph, order_of(graph, "metis-nd")), 25 * 25 * 25 / 2);
  EXPECT_GT(factor_entries(graph, order_of(graph, "metis-nd").inverse()), 25 * 25 * 25);
}

TEST(Metis, RecursiveBisectionKeepsHalvesTogether) {
  // the two halves of a dumbbell come one after the other
  const CsrGraph halves = test::disjoint_union({test::grid(16, 8), test::grid(16, 8)});
  std::vector<Edge> edges{{127, 128}};
  for (Index v = 0; v < halves.size(); ++v) {
    for (const Index u : halves[v]) edges.push_back({u, v});
  }
  const CsrGraph dumbbell = graph_from_edges(halves.size(), edges);
  const auto sequence = order_of(dumbbell, "metis-rb").new_to_old();
  for (std::size_t k = 0; k < sequence.size(); ++k) {
    EXPECT_EQ(sequence[k] < 128, (k < 128) == (sequence[0] < 128)) << k;
  }
}

TEST(Metis, PrintsNothingOnGraphsThatBisectBadly) {
  std::vector<Edge> star;
  for (Index v = 1; v < 3000; ++v) star.push_back({0, v});
  std::vector<Edge> pairs;
  for (Index v = 0; v + 1 < 3000; v += 2) pairs.push_back({v, v + 1});
  testing::internal::CaptureStdout();
  for (const auto& edges : {star, pairs}) {
    for (const char* method : {"metis-nd", "metis-rb"}) {
      EXPECT_EQ(order_of(graph_from_edges(3000, edges), method).size(), 3000);
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace meshorder
