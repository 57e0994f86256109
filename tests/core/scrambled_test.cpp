// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace meshorder {
namespace {

Permutation order_scrambled(const CsrGraph& graph, std::uint64_t seed) {
  OrderOptions options;
  options.seed = seed;
  return order_graph("scrambled", {graph, {}}, options).permutation;
}

TEST(Scrambled, IsSeeded) {
  const CsrGraph graph = test::cycle(200);
  EXPECT_EQ(order_scrambled(graph, 5), order_scrambled(graph, 5));
  EXPECT_NE(order_scrambled(graph, 5), order_scrambled(graph, 6));
  EXPECT_FALSE(order_scrambled(graph, 0).is_identity());
}

TEST(Scrambled, HasAMeanSpanOfAThird) {
  const CsrGraph graph = test::grid(100, 100);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    EXPECT_NEAR(edge_span(graph, order_scrambled(graph, seed)).mean, 1e4 / 3, 0.02 * 1e4);
  }
}

TEST(Scrambled, TakesEachOrderEquallyOften) {
  const CsrGraph graph = test::cycle(4);
  std::map<std::vector<Index>, int> counts;
  const int trials = 24000;
  for (int seed = 0; seed < trials; ++seed) {
    ++counts[order_scrambled(graph, static_cast<std::uint64_t>(seed)).new_to_old()];
  }
  ASSERT_EQ(counts.size(), 24U);
  double chi_squared = 0;
  for (const auto& [order, count] : counts) chi_squared += (count - 1000.0) * (count - 1000.0) / 1000;
  EXPECT_LT(chi_squared, 60) << "23 degrees of freedom: above 60 once in 30,000";
}

TEST(Scrambled, OfElementsIsSeededToo) {
  Incidence elements;
  elements.vertex_count = 1;
  for (Index e = 1; e <= 100; ++e) {
    elements.vertices.push_back(0);
    elements.offsets.push_back(e);
  }
  const Permutation vertices = Permutation::identity(1);
  const auto order = [&](std::uint64_t seed) {
    OrderOptions options;
    options.seed = seed;
    return order_incidence("scrambled", {elements, vertices, {}, {}}, options).permutation;
  };
  EXPECT_EQ(order(1), order(1));
  EXPECT_NE(order(1), order(2));
}

}  // namespace
}  // namespace meshorder
