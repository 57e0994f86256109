// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/block_galerkin.hpp"

#include "base/random.hpp"
#include "kernels/aligned.hpp"
#include "lab/linear/multigrid/rigid_modes.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <numeric>

namespace meshorder {
namespace {

template <class Number, int R, int C>
Eigen::MatrixXd dense(const BlockRows<Number, R, C>& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(R * matrix.rows(), C * matrix.columns_count);
  for (Index i = 0; i < matrix.rows(); ++i) {
    for (Offset k = matrix.offsets[i]; k < matrix.offsets[i + 1]; ++k) {
      for (int e = 0; e < R * C; ++e) {
        result(R * i + e / C, C * matrix.columns[k] + e % C) = static_cast<double>(matrix.block(k)[e]);
      }
    }
  }
  return result;
}

/// A symmetric matrix of random blocks on a ring with chords, and the points of its rows.
template <int R>
struct RandomMatrix {
  BlockRows<double, R, R> matrix;
  std::vector<Index> order, number;  ///< a reversal
  std::vector<Point> points;         ///< in the order of the view

  explicit RandomMatrix(Index n) : order(n), number(n) {
    Random random(3);
    Eigen::MatrixXd full = Eigen::MatrixXd::Random(R * n, R * n);
    full = (full + full.transpose()).eval();
    matrix.columns_count = n;
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j) {
        const Index apart = std::abs(i - j);
        if (apart > 1 && apart != n - 1 && apart != 5) continue;
        matrix.columns.push_back(j);
        for (int e = 0; e < R * R; ++e) matrix.values.push_back(full(R * i + e / R, R * j + e % R));
      }
      matrix.offsets.push_back(static_cast<Offset>(matrix.columns.size()));
      points.push_back({random.unit(), random.unit(), random.unit()});
      order[i] = number[i] = n - 1 - i;
    }
  }
  [[nodiscard]] BlockView<R> view() const {
    return {matrix.offsets, matrix.columns, matrix.values, order, number};
  }
  /// In the order of the view.
  [[nodiscard]] Eigen::MatrixXd dense_view() const {
    const Eigen::MatrixXd held = dense(matrix);
    Eigen::MatrixXd result(held.rows(), held.cols());
    for (Index i = 0; i < index_size(order); ++i) {
      for (Index j = 0; j < index_size(order); ++j) {
        result.block<R, R>(R * i, R * j) = held.block<R, R>(R * order[i], R * order[j]);
      }
    }
    return result;
  }
};

/// Aggregates of four, the last vertex in none.
Aggregates fours(Index n) {
  Aggregates result;
  result.members.resize(n - 1);
  std::iota(result.members.begin(), result.members.end(), 0);
  for (Index end = 4; end < n - 1; end += 4) result.starts.push_back(end);
  result.starts.push_back(n - 1);
  return result;
}

Eigen::MatrixXd mode_matrix(const std::vector<double>& modes) {
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, kRigidModes, Eigen::RowMajor>>(
      modes.data(), static_cast<Eigen::Index>(modes.size()) / kRigidModes, kRigidModes);
}

TEST(RigidModes, AreDisplacementsThatStrainNothing) {
  const std::vector<Point> points{{1, 2, 3}, {4, -1, 0}, {0, 0, 1}, {2, 2, 2}};
  const Eigen::MatrixXd modes = mode_matrix(rigid_modes(points));
  EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXd>(modes).rank(), 6);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < a; ++b) {
      Eigen::RowVector3d edge;
      for (int c = 0; c < 3; ++c) edge[c] = points[a][c] - points[b][c];
      const Eigen::MatrixXd change = edge * (modes.middleRows<3>(3 * a) - modes.middleRows<3>(3 * b));
      EXPECT_LT(change.cwiseAbs().maxCoeff(), 1e-14);
    }
  }
}

TEST(RigidProlongation, GivesTheModesBackWithOrthonormalColumns) {
  const RandomMatrix<3> fine(29);
  const std::vector<double> modes = rigid_modes(fine.points);
  const RigidProlongation<3> rigid = rigid_prolongation<3>(fours(29), 29, modes);
  const Eigen::MatrixXd p = dense(rigid.prolongation);
  const auto identity = Eigen::MatrixXd::Identity(p.cols(), p.cols());
  EXPECT_LT((p.transpose() * p - identity).cwiseAbs().maxCoeff(), 1e-6);
  const Eigen::MatrixXd difference = p * mode_matrix(rigid.coarse_modes) - mode_matrix(modes);
  EXPECT_LT(difference.topRows(3 * 28).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(p.bottomRows(3).cwiseAbs().maxCoeff(), 0.0);

  // and once more, from nodes of six unknowns
  const Index coarse = rigid.prolongation.columns_count;
  const RigidProlongation<6> next = rigid_prolongation<6>(fours(coarse), coarse, rigid.coarse_modes);
  const Eigen::MatrixXd next_difference =
      dense(next.prolongation) * mode_matrix(next.coarse_modes) - mode_matrix(rigid.coarse_modes);
  EXPECT_LT(next_difference.topRows(6 * (coarse - 1)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(RigidProlongation, LeavesOutModesThatAnAggregateCannotTell) {
  // far from the mean of all points, where rotations are large
  std::vector<Point> points{{50, 50, 50}, {-90, 3, 1}, {-89, 4, 2}, {-88, 5, 3},
                            {7, 7, 0},    {8, 7, 0},   {7, 8, 0}};
  const Aggregates aggregates{{0, 1, 4, 7}, {0, 1, 2, 3, 4, 5, 6}};  // a point, a line, a triangle
  const std::vector<double> modes = rigid_modes(points);
  const RigidProlongation<3> rigid = rigid_prolongation<3>(aggregates, 7, modes);
  const Eigen::MatrixXd p = dense(rigid.prolongation);
  const int kept[3] = {3, 5, 6};
  for (int a = 0; a < 3; ++a) {
    const Eigen::VectorXd norms = p.middleCols<6>(6 * a).colwise().norm();
    EXPECT_EQ((norms.array() > 0).count(), kept[a]) << "aggregate " << a;
    EXPECT_LT((norms.array() * (norms.array() - 1)).abs().maxCoeff(), 1e-6);
  }
  const Eigen::MatrixXd difference = p * mode_matrix(rigid.coarse_modes) - mode_matrix(modes);
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-5 * 90);
}

template <int R>
void expect_product(const RandomMatrix<R>& fine, const Prolongation<R>& prolongation) {
  const ColumnBlocks transposed = column_blocks<R>(prolongation);
  CoarseMatrix coarse = galerkin_pattern<R>(fine.view(), prolongation, transposed);
  galerkin_product<R>(fine.view(), prolongation, transposed, coarse);
  const Eigen::MatrixXd p = dense(prolongation);
  const Eigen::MatrixXd expected = p.transpose() * fine.dense_view() * p;
  const Eigen::MatrixXd actual = dense(coarse);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    if (p.col(i).norm() == 0) continue;  // has a pivot of its own
    EXPECT_LT((actual.row(i) - expected.row(i)).cwiseAbs().maxCoeff(), 1e-12 * expected.norm()) << i;
  }
}

TEST(BlockGalerkin, EqualsTheDenseProduct) {
  const RandomMatrix<3> fine(150);
  const RigidProlongation<3> rigid = rigid_prolongation<3>(fours(150), 150, rigid_modes(fine.points));
  expect_product(fine, rigid.prolongation);
}

TEST(BlockGalerkin, EqualsTheDenseProductWithASmoothedProlongation) {
  const RandomMatrix<6> fine(41);
  std::vector<double> modes(36 * 41);
  Random random(5);
  for (double& mode : modes) mode = random.unit() - 0.5;
  const Prolongation<6> tentative = rigid_prolongation<6>(fours(41), 41, modes).prolongation;
  AlignedVector<float> inverse(36 * 41);
  for (Index i = 0; i < 41; ++i) {
    for (int e = 0; e < 36; ++e) {
      const int sum = e % 6 + e / 6 + i % 3;  // a symmetric block
      inverse[36 * i + e] = static_cast<float>(1 + sum);
    }
  }
  Prolongation<6> smoothed = smoothed_pattern(fine.view(), tentative);
  smooth_prolongation(fine.view(), inverse, 0.01, tentative, smoothed);

  Eigen::MatrixXd scale = Eigen::MatrixXd::Zero(6 * 41, 6 * 41);
  for (Index i = 0; i < 41; ++i) {
    scale.block<6, 6>(6 * i, 6 * i) =
        Eigen::Map<const Eigen::Matrix<float, 6, 6>>(inverse.data() + 36 * i).cast<double>();
  }
  const Eigen::MatrixXd p = dense(tentative);
  const Eigen::MatrixXd expected = p - 0.01 * scale * fine.dense_view() * p;
  EXPECT_LT((dense(smoothed) - expected).cwiseAbs().maxCoeff(), 1e-6 * expected.norm());
  expect_product(fine, smoothed);
}

TEST(BlockGalerkin, GivesUnknownsThatAreLeftOutAPivot) {
  const RandomMatrix<3> fine(9);
  Aggregates alone;  // vertex 2 by itself has no rotations
  alone.starts = {0, 1};
  alone.members = {2};
  const Prolongation<3> p = rigid_prolongation<3>(alone, 9, rigid_modes(fine.points)).prolongation;
  const ColumnBlocks transposed = column_blocks<3>(p);
  CoarseMatrix coarse = galerkin_pattern<3>(fine.view(), p, transposed);
  galerkin_product<3>(fine.view(), p, transposed, coarse);
  const Eigen::MatrixXd block = dense(coarse);
  ASSERT_EQ(block.rows(), 6);
  for (int i = 3; i < 6; ++i) {
    EXPECT_GT(block(i, i), 0.0);
    EXPECT_EQ(block.row(i).cwiseAbs().sum(), block(i, i));
  }
}

}  // namespace
}  // namespace meshorder
