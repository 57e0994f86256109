// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/block_sweeps.hpp"

#include "payoff/deformed.hpp"
#include "support/sample_graphs.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>
#include <vector>

namespace meshorder {
namespace {

/// A symmetric positive definite matrix of blocks on a band, long enough for several chunks.
template <int R>
struct Band {
  static constexpr Index kRows = 600;
  BlockRows<double, R, R> matrix;
  std::vector<Index> order, number;  ///< a reversal
  Eigen::MatrixXd dense;             ///< in the order of the view

  explicit Band(Index reach = 7)
      : order(kRows), number(kRows), dense(Eigen::MatrixXd::Zero(R * kRows, R * kRows)) {
    Random random(2);
    for (Index i = 0; i < R * kRows; ++i) {
      for (Index j = 0; j <= i; ++j) {
        if (i / R - j / R <= reach && (i / R - j / R) % 3 != 2)
          dense(i, j) = dense(j, i) = random.unit() - 0.5;
      }
      dense(i, i) += 20;
    }
    for (Index i = 0; i < kRows; ++i) order[i] = number[i] = kRows - 1 - i;
    for (Index i = 0; i < kRows; ++i) {
      for (Index j = 0; j < kRows; ++j) {
        const Eigen::MatrixXd block = dense.block<R, R>(R * order[i], R * order[j]);
        if (block.isZero(0)) continue;
        matrix.columns.push_back(j);
        for (int e = 0; e < R * R; ++e) matrix.values.push_back(block(e / R, e % R));
      }
      matrix.offsets.push_back(static_cast<Offset>(matrix.columns.size()));
    }
  }
  [[nodiscard]] BlockView<R> view() const {
    return {matrix.offsets, matrix.columns, matrix.values, order, number};
  }
};

template <int R>
AlignedVector<float> padded(const Eigen::VectorXd& x) {
  AlignedVector<float> result(kNodeStride<R> * x.size() / R, 0.0F);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    result[kNodeStride<R> * (i / R) + i % R] = static_cast<float>(x[i]);
  }
  return result;
}

template <int R>
Eigen::VectorXd compact(const AlignedVector<float>& x) {
  Eigen::VectorXd result(R * static_cast<Eigen::Index>(x.size()) / kNodeStride<R>);
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    result[i] = static_cast<double>(x[kNodeStride<R> * (i / R) + i % R]);
  }
  return result;
}

/// The part of A to the left of D in the order of the sweeps: columns of rows that are in chunks of an
/// earlier colour, or earlier in the same chunk.
template <int R>
Eigen::MatrixXd left_of(const Band<R>& band, const RowChunks& chunks) {
  std::vector<Index> place(Band<R>::kRows);
  Index next = 0;
  for (const std::vector<Index>& colour : chunks.colours()) {
    for (const Index chunk : colour) {
      for (Index i = chunk * chunks.size(); i < std::min((chunk + 1) * chunks.size(), Band<R>::kRows); ++i) {
        place[i] = next++;
      }
    }
  }
  Eigen::MatrixXd left = band.dense;
  for (Index i = 0; i < Band<R>::kRows; ++i) {
    for (Index j = 0; j < Band<R>::kRows; ++j) {
      if (place[j] >= place[i]) left.block<R, R>(R * i, R * j).setZero();
    }
  }
  return left;
}

template <int R>
void expect_sweeps_of_a_dense_matrix() {
  const Band<R> band;
  BlockSweeps<R> sweeps(band.view(), 128);
  sweeps.update(band.view());
  ASSERT_GE(sweeps.chunks().count(), 4);
  const Eigen::SparseMatrix<double> left = left_of(band, sweeps.chunks()).sparseView();
  const Eigen::SparseMatrix<double> matrix = band.dense.sparseView();
  const Eigen::SparseMatrix<double> diagonal = matrix - left - Eigen::SparseMatrix<double>(left.transpose());
  const Eigen::Index n = R * Band<R>::kRows;
  const Eigen::VectorXd b =
      Eigen::VectorXd::NullaryExpr(n, [](Eigen::Index i) { return std::sin(static_cast<double>(i)); });
  const AlignedVector<float> padded_b = padded<R>(b);
  const std::size_t size = padded_b.size();

  test::for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    AlignedVector<float> x(size), residual(size), after(size);
    typename BlockSweeps<R>::Given given{AlignedVector<float>(size), AlignedVector<float>(size)};
    sweeps.forwards(padded_b, x, residual, given);
    const AlignedVector<float> before = x;
    const Eigen::VectorXd forwards = compact<R>(x);
    EXPECT_LT((left * forwards + diagonal * forwards - b).norm(), 1e-6 * b.norm());
    EXPECT_LT((compact<R>(residual) - (b - matrix * forwards)).norm(), 1e-6 * b.norm());

    sweeps.backwards(padded_b, x, given);
    const Eigen::VectorXd backwards = compact<R>(x);
    const Eigen::VectorXd right_side = b - left * forwards;
    EXPECT_LT((left.transpose() * backwards + diagonal * backwards - right_side).norm(), 1e-6 * b.norm());
    sweeps.residual_after_backwards(before, x, after);
    EXPECT_LT((compact<R>(after) - (b - matrix * backwards)).norm(), 1e-6 * b.norm());
  });
}

TEST(BlockSweeps, SolveTheTrianglesOfADenseMatrix) {
  expect_sweeps_of_a_dense_matrix<3>();
  expect_sweeps_of_a_dense_matrix<6>();
}

TEST(BlockSweeps, GiveTheSameBitsWhereChunksMeetInOneRow) {
  // rows in the middle of a chunk of 64 have neighbours in those before and after it
  const Band<3> band(50);
  BlockSweeps<3> sweeps(band.view(), 32);
  sweeps.update(band.view());
  ASSERT_EQ(sweeps.chunks().size(), 64);
  const std::size_t size = kNodeStride<3> * Band<3>::kRows;
  AlignedVector<float> b(size);
  for (std::size_t i = 0; i < size; ++i) b[i] = i % 4 == 3 ? 0.0F : std::sin(static_cast<float>(i));
  AlignedVector<float> x(size), residual(size), first;
  BlockSweeps<3>::Given given{AlignedVector<float>(size), AlignedVector<float>(size)};
  const auto sweep = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    sweeps.forwards(b, x, residual, given);
    sweeps.backwards(b, x, given);
    if (first.empty()) first = x;
    return x == first;
  };
  ASSERT_TRUE(sweep(1));
  for (int repeat = 0; repeat < (test::kSanitized ? 50 : 300); ++repeat) ASSERT_TRUE(sweep(3)) << repeat;
}

}  // namespace
}  // namespace meshorder
