// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/measures.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

Permutation as_it_is(const CsrGraph& graph) { return Permutation::identity(graph.size()); }

TEST(Convergence, APathInItsOrderIsFactoredExactly) {
  const CsrGraph path = test::path(400);
  EXPECT_LE(iterations_in(path, as_it_is(path)).incomplete_cholesky, 2);
  EXPECT_GT(iterations_in(path, test::shuffled(path.size(), 1)).incomplete_cholesky, 10);
}

TEST(Convergence, OfALatticeTakesFewerIterationsRowByRow) {
  const CsrGraph grid = test::grid(60, 60);
  const Iterations by_rows = iterations_in(grid, as_it_is(grid));
  const Iterations shuffled = iterations_in(grid, test::shuffled(grid.size(), 1));
  EXPECT_LT(by_rows.incomplete_cholesky, shuffled.incomplete_cholesky);
  EXPECT_LT(by_rows.gauss_seidel, shuffled.gauss_seidel);
  EXPECT_LT(by_rows.incomplete_cholesky, by_rows.gauss_seidel);
  EXPECT_EQ(by_rows, iterations_in(grid, as_it_is(grid)));
}

TEST(Convergence, TakesGraphsWithoutEdgesAndWithoutVertices) {
  const CsrGraph apart = test::disjoint_union({test::path(1), test::path(1)});
  EXPECT_LE(iterations_in(apart, as_it_is(apart)).incomplete_cholesky, 1);
  EXPECT_EQ(iterations_in(CsrGraph{{0}, {}}, Permutation()), Iterations{});
}

}  // namespace
}  // namespace meshorder
