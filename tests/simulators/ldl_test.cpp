// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cholesky/ldl.hpp"

#include "simulators/sparse.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace meshorder {
namespace {

void expect_factors(const SparseMatrix& matrix) {
  const Ldl ldl = factor_ldl(matrix);
  const Index n = matrix.size();
  ASSERT_EQ(ldl.size(), n);
  ASSERT_EQ(index_size(ldl.pivots), n);
  Eigen::MatrixXd lower = Eigen::MatrixXd::Identity(n, n);
  for (Index j = 0; j < n; ++j) {
    EXPECT_TRUE(std::is_sorted(ldl.rows.begin() + ldl.offsets[j], ldl.rows.begin() + ldl.offsets[j + 1]));
    for (Offset k = ldl.offsets[j]; k < ldl.offsets[j + 1]; ++k) {
      ASSERT_GT(ldl.rows[k], j);
      lower(ldl.rows[k], j) = ldl.values[k];
    }
  }
  const Eigen::Map<const Eigen::VectorXd> pivots(ldl.pivots.data(), n);
  const Eigen::MatrixXd product = lower * pivots.asDiagonal() * lower.transpose();
  const Eigen::MatrixXd expected = test::dense(matrix)(ldl.new_to_old, ldl.new_to_old);
  EXPECT_LT((product - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
}

TEST(FactorLdl, GivesFactorsWhoseProductIsTheMatrix) {
  for (const CsrGraph& graph : {test::path(1), test::path(30), test::star(20), test::complete(12),
                                test::grid(6, 5, 4), test::random_connected(90, 150, 2),
                                test::disjoint_union({test::cycle(8), test::path(1), test::complete(5)})}) {
    expect_factors(test::shifted_laplacian(graph, 0.1));
  }
}

TEST(FactorLdl, IsSparseOnAGridInThePlane) {
  // at most 31/4 n log₂ n entries (George 1973)
  const Index side = 100;
  const Ldl ldl = factor_ldl(test::shifted_laplacian(test::grid(side, side), 0.1));
  const double n = side * side;
  EXPECT_LT(static_cast<double>(ldl.offsets.back()), 31.0 / 4.0 * n * std::log2(side));
}

TEST(FactorLdl, IsTheSameOnEveryRun) {
  const SparseMatrix matrix = test::shifted_laplacian(test::grid(30, 30, 3), 0.1);
  const Ldl first = factor_ldl(matrix);
  const Ldl second = factor_ldl(matrix);
  EXPECT_EQ(first.new_to_old, second.new_to_old);
  EXPECT_EQ(first.values, second.values);
  EXPECT_EQ(first.pivots, second.pivots);
}

}  // namespace
}  // namespace meshorder
