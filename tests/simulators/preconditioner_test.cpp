// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cg/solve.hpp"
#include "lab/linear/preconditioners/incomplete_cholesky.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "payoff/deformed.hpp"
#include "simulators/elastic_system.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <limits>

namespace meshorder {
namespace {

constexpr std::array kKinds{PreconditionerKind::jacobi, PreconditionerKind::block_jacobi,
                            PreconditionerKind::incomplete_cholesky};

std::unique_ptr<Preconditioner> updated(PreconditionerKind kind, const BlockCsr& matrix) {
  auto result =
      make_preconditioner(kind, matrix, std::vector<Point>(static_cast<std::size_t>(matrix.size())));
  result->update(matrix);
  return result;
}

std::vector<double> applied(const Preconditioner& preconditioner, const std::vector<double>& r) {
  std::vector<double> z(r.size(), std::numeric_limits<double>::quiet_NaN());
  preconditioner.apply(r, z);
  return z;
}

/// Returns the preconditioner as a dense matrix.
Eigen::MatrixXd dense(const Preconditioner& preconditioner, Index vertices) {
  Eigen::MatrixXd result(3 * vertices, 3 * vertices);
  for (Index i = 0; i < 3 * vertices; ++i) {
    std::vector<double> unit(3 * static_cast<std::size_t>(vertices));
    unit[i] = 1.0;
    result.col(i) = test::as_eigen(applied(preconditioner, unit));
  }
  return result;
}

/// A symmetric positive definite matrix on the graph: random blocks and a dominant diagonal.
BlockCsr definite_matrix(const CsrGraph& graph, double diagonal) {
  BlockCsr matrix = zero_block_csr(graph);
  Random random(11);
  for (Index v = 0; v < matrix.size(); ++v) {
    for (Offset k = matrix.offsets[v]; matrix.columns[k] <= v; ++k) {
      const Index u = matrix.columns[k];
      double* const block = matrix.values.data() + 9 * k;
      double* const transposed = matrix.values.data() + 9 * matrix.find(u, v);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < (u == v ? i + 1 : 3); ++j) {
          const double value = random.unit() - 0.5;
          block[3 * i + j] = value;
          transposed[3 * j + i] = value;
        }
        if (u == v) block[4 * i] += diagonal;
      }
      if (u == v) break;
    }
  }
  return matrix;
}

class AnyPreconditioner : public testing::TestWithParam<PreconditionerKind> {};
INSTANTIATE_TEST_SUITE_P(OfEveryKind, AnyPreconditioner, testing::ValuesIn(kKinds));

TEST_P(AnyPreconditioner, IsSymmetricAndPositiveDefinite) {
  for (const Mesh& mesh : {make_grid({.size = 3}), test::tetrahedral_bar(5)}) {
    const BlockCsr matrix = test::elastic_system(mesh, 1.0);
    const Eigen::MatrixXd inverse = dense(*updated(GetParam(), matrix), matrix.size());
    EXPECT_LT((inverse - inverse.transpose()).cwiseAbs().maxCoeff(), 1e-12 * inverse.cwiseAbs().maxCoeff());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(inverse).eigenvalues().minCoeff(), 0.0);
  }
}

TEST_P(AnyPreconditioner, IsPositiveDefiniteWhateverTheMatrix) {
  BlockCsr matrix = definite_matrix(test::complete(5), 0.1);
  matrix.values[9 * matrix.find(1, 1)] = 0.0;
  matrix.values[9 * matrix.find(2, 2) + 4] = -3.0;
  for (const double bad : {0.0, 1e308, std::numeric_limits<double>::quiet_NaN()}) {
    matrix.values[9 * matrix.find(3, 3) + 8] = bad;
    const Eigen::MatrixXd inverse = dense(*updated(GetParam(), matrix), matrix.size());
    EXPECT_TRUE(inverse.allFinite()) << bad;
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(inverse).eigenvalues().minCoeff(), 0.0) << bad;
  }
}

TEST_P(AnyPreconditioner, IsTheSameOnEveryUpdateWithTheSameMatrix) {
  const BlockCsr matrix = test::elastic_system(make_grid({.size = 3}), 1.0);
  const std::vector<double> r = test::random_vector(matrix.size(), 1);
  const auto preconditioner = updated(GetParam(), matrix);
  const std::vector<double> z = applied(*preconditioner, r);
  preconditioner->update(definite_matrix(vertex_graph(make_grid({.size = 3})), 9.0));
  EXPECT_NE(applied(*preconditioner, r), z);
  preconditioner->update(matrix);
  EXPECT_EQ(applied(*preconditioner, r), z);
  EXPECT_GE(preconditioner->bytes(), 3 * sizeof(double) * static_cast<std::size_t>(matrix.size()));
}

TEST_P(AnyPreconditioner, GivesTheSameBitsOnAnyNumberOfThreads) {
  const BlockCsr matrix = test::elastic_system(make_grid({.size = 26}), 1.0);
  const std::vector<double> r = test::random_vector(matrix.size(), 2);
  const auto result = [&](int threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<double> z;
    tbb::task_arena(threads).execute([&] { z = applied(*updated(GetParam(), matrix), r); });
    return z;
  };
  const std::vector<double> one = result(1);
  EXPECT_EQ(result(2), one);
  EXPECT_EQ(result(3), one);
}

TEST_P(AnyPreconditioner, RefusesWhatDoesNotFit) {
  const BlockCsr matrix = definite_matrix(test::path(4), 9.0);
  const auto preconditioner = updated(GetParam(), matrix);
  EXPECT_THROW(preconditioner->update(definite_matrix(test::path(5), 9.0)), InvalidArgument);
  std::vector<double> right(12);
  std::vector<double> wrong(15);
  EXPECT_THROW(preconditioner->apply(wrong, right), InvalidArgument);
  EXPECT_THROW(preconditioner->apply(right, wrong), InvalidArgument);
  EXPECT_THROW(make_preconditioner(GetParam(), matrix, std::vector<Point>(5)), InvalidArgument);
}

TEST(Preconditioners, HaveNames) {
  EXPECT_EQ(to_string(PreconditionerKind::jacobi), "jacobi");
  EXPECT_EQ(to_string(PreconditionerKind::block_jacobi), "block-jacobi");
  EXPECT_EQ(to_string(PreconditionerKind::incomplete_cholesky), "incomplete-cholesky");
  EXPECT_EQ(to_string(PreconditionerKind::multigrid), "multigrid");
}

TEST(Jacobi, InvertsTheDiagonal) {
  const BlockCsr matrix = definite_matrix(test::complete(6), 4.0);
  const Eigen::MatrixXd expected = test::dense(matrix).diagonal().cwiseInverse().asDiagonal();
  EXPECT_LT((dense(*updated(PreconditionerKind::jacobi, matrix), 6) - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(BlockJacobi, InvertsTheBlocksOfTheDiagonal) {
  const BlockCsr matrix = definite_matrix(test::complete(6), 2.0);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(18, 18);
  for (Index v = 0; v < 6; ++v) {
    expected.block<3, 3>(3 * v, 3 * v) = test::dense(matrix).block<3, 3>(3 * v, 3 * v).inverse();
  }
  EXPECT_LT((dense(*updated(PreconditionerKind::block_jacobi, matrix), 6) - expected).cwiseAbs().maxCoeff(),
            1e-14);
}

// up to the rounding to float
constexpr double kExact = 3e-6;

TEST(IncompleteCholesky, IsExactWhereNothingIsLeftOutWithEveryInstructionSet) {
  // a path has no fill, a complete graph has room for all fill
  for (const CsrGraph& graph : {test::path(20), test::complete(7), test::path(1)}) {
    const BlockCsr matrix = definite_matrix(graph, 6.0);
    const Eigen::MatrixXd expected = test::dense(matrix).inverse();
    test::for_each_target([&](const char* target) {
      SCOPED_TRACE(target);
      IncompleteCholesky factor(matrix);
      factor.update(matrix);
      EXPECT_EQ(factor.shift(), 0.0);
      EXPECT_LT((dense(factor, matrix.size()) - expected).norm(), kExact * expected.norm());
    });
  }
}

TEST(IncompleteCholesky, LeavesOutLittleWhereChunksJoin) {
  // a path so long that it is cut into four chunks. After each cut one block of fill is left out, which
  // changes two eigenvalues of M⁻¹A from 1, each of multiplicity three
  const Index n = 50'000;
  BlockCsr matrix = zero_block_csr(test::path(n));
  for (Index v = 0; v < n; ++v) {
    for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
      for (int c = 0; c < 3; ++c) matrix.values[9 * k + 4 * c] = matrix.columns[k] == v ? 2.01 : -1.0;
    }
  }
  const std::vector<double> b = test::random_vector(n, 3);
  std::vector<double> x(b.size());
  const SolveReport report = conjugate_gradients(
      matrix, *updated(PreconditionerKind::incomplete_cholesky, matrix), b, x, {.tolerance = 1e-4});
  EXPECT_EQ(report.status, SolveStatus::converged);
  EXPECT_GT(report.iterations, 1);
  EXPECT_LE(report.iterations, 7);
}

/// (L D Lᵀ)⁻¹ by textbook loops over full matrices that skip entries outside the pattern.
Eigen::MatrixXd dense_incomplete_inverse(const BlockCsr& matrix, double shift) {
  const Index n = matrix.size();
  Eigen::MatrixXd a = test::dense(matrix);
  for (Index v = 0; v < n; ++v) a.block<3, 3>(3 * v, 3 * v) *= 1.0 + shift;
  Eigen::MatrixXd lower = Eigen::MatrixXd::Identity(3 * n, 3 * n);
  Eigen::MatrixXd pivots = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Index k = 0; k < n; ++k) {
    const Eigen::Matrix3d pivot = a.block<3, 3>(3 * k, 3 * k);
    pivots.block<3, 3>(3 * k, 3 * k) = pivot;
    for (Index i = k + 1; i < n; ++i) {
      if (matrix.find(i, k) < 0) continue;
      lower.block<3, 3>(3 * i, 3 * k) = a.block<3, 3>(3 * i, 3 * k) * pivot.inverse();
      for (Index j = k + 1; j < n; ++j) {
        if (matrix.find(j, k) < 0 || matrix.find(i, j) < 0) continue;
        a.block<3, 3>(3 * i, 3 * j) -= lower.block<3, 3>(3 * i, 3 * k) * a.block<3, 3>(3 * k, 3 * j);
      }
    }
  }
  return (lower * pivots * lower.transpose()).inverse();
}

TEST(IncompleteCholesky, EqualsTheDenseOne) {
  const BlockCsr matrix = definite_matrix(test::random_connected(30, 40, 4), 8.0);
  IncompleteCholesky factor(matrix);
  factor.update(matrix);
  EXPECT_EQ(factor.shift(), 0.0);
  const Eigen::MatrixXd expected = dense_incomplete_inverse(matrix, 0.0);
  EXPECT_LT((dense(factor, matrix.size()) - expected).norm(), kExact * expected.norm());
  EXPECT_GT((test::dense(matrix).inverse() - expected).norm(), 100 * kExact * expected.norm());
}

TEST(IncompleteCholesky, EnlargesTheDiagonalOfASolidAsMuchAsItMust) {
  const BlockCsr matrix = test::elastic_system(make_ball({.size = 6}), 0.01);
  IncompleteCholesky factor(matrix);
  factor.update(matrix);
  EXPECT_GT(factor.shift(), 0.0);
  EXPECT_LT(factor.shift(), 1.0);
  const Eigen::MatrixXd expected = dense_incomplete_inverse(matrix, factor.shift());
  EXPECT_LT((dense(factor, matrix.size()) - expected).norm(), 1e-4 * expected.norm());
}

TEST(IncompleteCholesky, TakesFewerIterationsThanBlocksAndTheseThanTheDiagonal) {
  // two chunks, in the grid's own order and scrambled
  for (const bool scrambled : {false, true}) {
    Mesh mesh = make_grid({.size = 26});
    if (scrambled)
      apply_reordering(mesh, test::shuffled(mesh.vertex_count(), 5), test::shuffled(mesh.cell_count(), 0));
    const BlockCsr matrix = test::elastic_system(mesh, 1.0);
    const std::vector<double> b(3 * static_cast<std::size_t>(matrix.size()), -0.5);
    std::array<int, kKinds.size()> iterations{};
    for (std::size_t i = 0; i < kKinds.size(); ++i) {
      std::vector<double> x(b.size());
      const SolveReport report = conjugate_gradients(matrix, *updated(kKinds[i], matrix), b, x);
      EXPECT_EQ(report.status, SolveStatus::converged);
      iterations[i] = report.iterations;
    }
    EXPECT_LE(iterations[1], iterations[0]);
    EXPECT_LT(2 * iterations[2], iterations[1]);
  }
}

TEST(Preconditioners, NeedADiagonal) {
  BlockCsr matrix = definite_matrix(test::path(3), 4.0);
  matrix.columns[0] = 2;
  for (const auto& [kind, name] : EnumNames<PreconditionerKind>::names)
    EXPECT_THROW((void)updated(kind, matrix), InvalidArgument) << name;
}

}  // namespace
}  // namespace meshorder
