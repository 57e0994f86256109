// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/graph_views.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace meshorder {
namespace {

using test::view_of;

TEST(SparsityPattern, CountsTheEntriesOfEachTile) {
  const CsrGraph graph = test::grid(5, 5, 5);
  const Permutation order = test::shuffled(graph.size(), 1);
  const SparsityPattern pattern = sparsity_pattern(view_of(graph), order, 7);
  std::vector<std::uint32_t> expected(49);
  for (Index row = 0; row < graph.size(); ++row) {
    for (Index column = 0; column < graph.size(); ++column) {
      const auto neighbours = graph[order.new_to_old()[row]];
      const bool entry = row == column || std::find(neighbours.begin(), neighbours.end(),
                                                    order.new_to_old()[column]) != neighbours.end();
      const Index tile = 7 * (7 * row / graph.size()) + 7 * column / graph.size();
      if (entry) ++expected[tile];
    }
  }
  EXPECT_EQ(pattern.side, 7);
  EXPECT_EQ(pattern.counts, expected);
}

TEST(SparsityPattern, OfFewVerticesHasATileForEach) {
  const CsrGraph path = test::path(3);
  const SparsityPattern pattern = sparsity_pattern(view_of(path), Permutation::identity(3), 192);
  EXPECT_EQ(pattern.side, 3);
  EXPECT_EQ(pattern.counts, (std::vector<std::uint32_t>{1, 1, 0, 1, 1, 1, 0, 1, 1}));
}

TEST(SparsityPattern, RefusesNoTilesAndOtherSizes) {
  const CsrGraph path = test::path(3);
  EXPECT_THROW((void)sparsity_pattern(view_of(path), Permutation::identity(3), 0), InvalidArgument);
  EXPECT_THROW((void)sparsity_pattern(view_of(path), Permutation::identity(2), 4), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
