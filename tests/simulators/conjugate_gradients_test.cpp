// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cg/solve.hpp"
#include "lab/linear/preconditioners/preconditioner.hpp"
#include "mesh/procedural.hpp"
#include "simulators/elastic_system.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>

namespace meshorder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::unique_ptr<Preconditioner> updated(PreconditionerKind kind, const BlockCsr& matrix) {
  auto result =
      make_preconditioner(kind, matrix, std::vector<Point>(static_cast<std::size_t>(matrix.size())));
  result->update(matrix);
  return result;
}

/// A diagonal matrix.
BlockCsr diagonal_matrix(const std::vector<double>& entries) {
  BlockCsr matrix = zero_block_csr(graph_from_edges(index_size(entries) / 3, {}));
  for (std::size_t i = 0; i < entries.size(); ++i) matrix.values[9 * (i / 3) + 4 * (i % 3)] = entries[i];
  return matrix;
}

/// z = r.
class Identity final : public Preconditioner {
 public:
  using Preconditioner::Preconditioner;
  [[nodiscard]] std::size_t bytes() const override { return 0; }

 private:
  void take(const BlockCsr& /*matrix*/) override {}
  void multiply(std::span<const double> r, std::span<double> z) const override {
    std::copy(r.begin(), r.end(), z.begin());
  }
};

class ConjugateGradients : public testing::TestWithParam<PreconditionerKind> {};
INSTANTIATE_TEST_SUITE_P(With, ConjugateGradients,
                         testing::Values(PreconditionerKind::jacobi, PreconditionerKind::block_jacobi,
                                         PreconditionerKind::incomplete_cholesky));

TEST_P(ConjugateGradients, SolveAsADenseFactorisationDoes) {
  for (const Mesh& mesh : {make_grid({.size = 4}), make_ball({.size = 4}), test::tetrahedral_bar(7)}) {
    const BlockCsr matrix = test::elastic_system(mesh, 0.1);
    const std::vector<double> b = test::random_vector(matrix.size(), 1);
    std::vector<double> x = test::random_vector(matrix.size(), 2);
    const SolveReport report =
        conjugate_gradients(matrix, *updated(GetParam(), matrix), b, x, {.tolerance = 1e-12});
    EXPECT_EQ(report.status, SolveStatus::converged);
    EXPECT_LE(report.residual, 1e-12);
    EXPECT_EQ(report.vertex, -1);
    const Eigen::VectorXd expected = test::dense(matrix).ldlt().solve(test::as_eigen(b));
    EXPECT_LT((test::as_eigen(x) - expected).norm(), 1e-9 * expected.norm());

    HalfBlockCsr half;
    store_half(matrix, half);
    std::vector<double> by_half = test::random_vector(matrix.size(), 2);
    const SolveReport with_half =
        conjugate_gradients(half, *updated(GetParam(), matrix), b, by_half, {.tolerance = 1e-12});
    EXPECT_EQ(with_half.status, SolveStatus::converged);
    EXPECT_NEAR(with_half.iterations, report.iterations, 2);
    EXPECT_LT((test::as_eigen(by_half) - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST_P(ConjugateGradients, GiveTheSameBitsOnAnyNumberOfThreads) {
  const BlockCsr matrix = test::elastic_system(make_grid({.size = 22}), 1.0);
  HalfBlockCsr half;
  store_half(matrix, half);
  HalfBlockCsrOf<float> rounded_half;
  store_half(matrix, rounded_half);
  const std::vector<double> b = test::random_vector(matrix.size(), 3);
  const auto preconditioner = updated(GetParam(), matrix);
  const auto solution = [&](const auto& of, int threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<double> x(b.size());
    tbb::task_arena(threads).execute(
        [&] { conjugate_gradients(of, *preconditioner, b, x, {.max_iterations = 20}); });
    return x;
  };
  const std::vector<double> one = solution(matrix, 1);
  const std::vector<double> one_by_half = solution(half, 1);
  const std::vector<double> one_by_rounded_half = solution(rounded_half, 1);
  for (const int threads : {2, 3, 8}) {
    EXPECT_EQ(solution(matrix, threads), one);
    EXPECT_EQ(solution(half, threads), one_by_half);
    EXPECT_EQ(solution(rounded_half, threads), one_by_rounded_half);
  }
}

TEST(ConjugateGradients, EndAfterAsManyIterationsAsThereAreDifferentEigenvalues) {
  std::vector<double> entries(300);
  for (int i = 0; i < 300; ++i) entries[i] = 1.0 + i % 5;
  const BlockCsr matrix = diagonal_matrix(entries);
  const std::vector<double> b = test::random_vector(matrix.size(), 4);
  std::vector<double> x(b.size());
  const SolveReport report = conjugate_gradients(matrix, Identity(matrix.size()), b, x, {.tolerance = 1e-12});
  EXPECT_EQ(report.status, SolveStatus::converged);
  EXPECT_EQ(report.iterations, 5);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], b[i] / entries[i], 1e-12);
}

TEST(ConjugateGradients, StayWhereTheResidualIsZero) {
  const BlockCsr matrix = diagonal_matrix({1, 2, 4, 1, 2, 4});
  std::vector<double> x(6);
  SolveReport report = conjugate_gradients(matrix, Identity(matrix.size()), std::vector<double>(6), x);
  EXPECT_EQ(report.status, SolveStatus::converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x, std::vector<double>(6));
  x.assign(6, 1.0);
  report = conjugate_gradients(matrix, Identity(matrix.size()), std::vector<double>{1, 2, 4, 1, 2, 4}, x);
  EXPECT_EQ(report.status, SolveStatus::converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x, std::vector<double>(6, 1.0));
}

TEST(ConjugateGradients, SolveTheEmptySystem) {
  const BlockCsr matrix = diagonal_matrix({});
  EXPECT_EQ(conjugate_gradients(matrix, *updated(PreconditionerKind::jacobi, matrix), {}, {}).status,
            SolveStatus::converged);
}

TEST(ConjugateGradients, GoOnFromTheStartGiven) {
  const BlockCsr matrix = test::elastic_system(make_grid({.size = 4}), 0.1);
  const auto jacobi = updated(PreconditionerKind::jacobi, matrix);
  const std::vector<double> b = test::random_vector(matrix.size(), 5);
  std::vector<double> x(b.size());
  const SolveReport first = conjugate_gradients(matrix, *jacobi, b, x, {.tolerance = 1e-10});
  // only rounding errors are left, which no start improves
  const SolveReport again = conjugate_gradients(matrix, *jacobi, b, x, {.tolerance = 1e-2});
  EXPECT_EQ(again.status, SolveStatus::converged);
  EXPECT_LT(again.iterations, first.iterations);
  const Eigen::VectorXd expected = test::dense(matrix).ldlt().solve(test::as_eigen(b));
  EXPECT_LT((test::as_eigen(x) - expected).norm(), 1e-9 * expected.norm());
}

TEST(ConjugateGradients, ReportTheResidualWhereTheIterationsEnd) {
  const BlockCsr matrix = test::elastic_system(make_grid({.size = 4}), 0.1);
  const std::vector<double> b = test::random_vector(matrix.size(), 6);
  for (const int iterations : {0, 1, 7}) {
    std::vector<double> x(b.size());
    const SolveReport report = conjugate_gradients(matrix, *updated(PreconditionerKind::jacobi, matrix), b, x,
                                                   {.max_iterations = iterations});
    EXPECT_EQ(report.status, SolveStatus::iteration_limit);
    EXPECT_EQ(report.iterations, iterations);
    const Eigen::VectorXd r = test::as_eigen(b) - test::dense(matrix) * test::as_eigen(x);
    EXPECT_NEAR(report.residual, r.norm() / test::as_eigen(b).norm(), 1e-12);
    Eigen::Index largest = 0;
    r.cwiseAbs().maxCoeff(&largest);
    EXPECT_EQ(report.vertex, largest / 3);
  }
}

TEST(ConjugateGradients, NoticeNegativeCurvature) {
  std::vector<double> entries(12, 1.0);
  entries[7] = -2.0;
  const BlockCsr matrix = diagonal_matrix(entries);
  std::vector<double> b(12, 0.1);
  b[7] = 1.0;
  std::vector<double> x(12);
  const SolveReport report = conjugate_gradients(matrix, Identity(matrix.size()), b, x);
  EXPECT_EQ(report.status, SolveStatus::negative_curvature);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.vertex, 2);
  EXPECT_EQ(x, std::vector<double>(12));
  // after a step along which the curvature was positive
  b.assign(12, 1.0);
  const SolveReport later = conjugate_gradients(matrix, Identity(matrix.size()), b, x);
  EXPECT_EQ(later.status, SolveStatus::negative_curvature);
  EXPECT_EQ(later.iterations, 1);
  EXPECT_GT(x[0], 0.0);
  EXPECT_EQ(x, std::vector<double>(12, x[0]));
}

/// z = −r at one vertex, r elsewhere.
class Indefinite final : public Preconditioner {
 public:
  using Preconditioner::Preconditioner;
  [[nodiscard]] std::size_t bytes() const override { return 0; }

 private:
  void take(const BlockCsr& /*matrix*/) override {}
  void multiply(std::span<const double> r, std::span<double> z) const override {
    std::copy(r.begin(), r.end(), z.begin());
    for (int c = 3; c < 6; ++c) z[c] = -r[c];
  }
};

TEST(ConjugateGradients, NoticeAPreconditionerThatIsNotDefinite) {
  const BlockCsr matrix = diagonal_matrix(std::vector<double>(9, 1.0));
  std::vector<double> b(9, 0.1);
  b[4] = 1.0;
  std::vector<double> x(9);
  const SolveReport report = conjugate_gradients(matrix, Indefinite(matrix.size()), b, x);
  EXPECT_EQ(report.status, SolveStatus::breakdown);
  EXPECT_EQ(report.vertex, 1);
  EXPECT_EQ(x, std::vector<double>(9));
}

TEST(ConjugateGradients, SayAtWhichVertexANumberIsNotFinite) {
  const Mesh mesh = make_grid({.size = 3});
  const BlockCsr matrix = test::elastic_system(mesh, 1.0);
  const auto jacobi = updated(PreconditionerKind::jacobi, matrix);
  const std::vector<double> b = test::random_vector(matrix.size(), 7);
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    std::vector<double> x(b.size());
    std::vector<double> bad_b = b;
    bad_b[3 * 17 + 1] = bad;
    SolveReport report = conjugate_gradients(matrix, *jacobi, bad_b, x);
    EXPECT_EQ(report.status, SolveStatus::not_finite);
    EXPECT_EQ(report.vertex, 17);
    EXPECT_EQ(report.iterations, 0);

    x[3 * 23 + 2] = bad;
    report = conjugate_gradients(matrix, *jacobi, b, x);
    EXPECT_EQ(report.status, SolveStatus::not_finite);
    EXPECT_EQ(report.vertex, 23);

    x.assign(b.size(), 0.0);
    BlockCsr bad_matrix = matrix;
    bad_matrix.values[9 * matrix.offsets[31] + 5] = bad;
    report = conjugate_gradients(bad_matrix, *updated(PreconditionerKind::jacobi, bad_matrix), b, x);
    EXPECT_EQ(report.status, SolveStatus::not_finite);
    EXPECT_EQ(report.vertex, 31);
  }
}

TEST(ConjugateGradients, SayWhatOverflows) {
  const BlockCsr matrix = diagonal_matrix(std::vector<double>(9, 1.0));
  std::vector<double> b(9, 1.0);
  b[8] = 1e200;
  std::vector<double> x(9);
  const SolveReport report = conjugate_gradients(matrix, Identity(matrix.size()), b, x);
  EXPECT_EQ(report.status, SolveStatus::not_finite);
  EXPECT_EQ(report.vertex, 2);
}

TEST(ConjugateGradients, RefuseWhatDoesNotFit) {
  const BlockCsr matrix = diagonal_matrix(std::vector<double>(9, 1.0));
  const auto jacobi = updated(PreconditionerKind::jacobi, matrix);
  std::vector<double> right(9);
  std::vector<double> wrong(8);
  EXPECT_THROW(conjugate_gradients(matrix, *jacobi, wrong, right), InvalidArgument);
  EXPECT_THROW(conjugate_gradients(matrix, *jacobi, right, wrong), InvalidArgument);
  EXPECT_THROW(conjugate_gradients(matrix, *jacobi, right, right, {.tolerance = -1.0}), InvalidArgument);
  EXPECT_THROW(conjugate_gradients(matrix, *jacobi, right, right, {.tolerance = kNan}), InvalidArgument);
  EXPECT_THROW(conjugate_gradients(matrix, *jacobi, right, right, {.max_iterations = -1}), InvalidArgument);
  const BlockCsr smaller = diagonal_matrix(std::vector<double>(6, 1.0));
  const std::vector<double> b(9, 1.0);
  EXPECT_THROW(conjugate_gradients(matrix, *updated(PreconditionerKind::jacobi, smaller), b, right),
               InvalidArgument);
}

TEST(ConjugateGradients, TakeAMatrixInSinglePrecision) {
  const BlockCsr matrix = test::elastic_system(make_grid({.size = 4}), 1.0);
  BlockCsrOf<float> rounded;
  round_to_single(matrix, rounded);
  const std::vector<double> b = test::random_vector(matrix.size(), 8);
  std::vector<double> x(b.size());
  const SolveReport report =
      conjugate_gradients(rounded, *updated(PreconditionerKind::jacobi, matrix), b, x, {.tolerance = 1e-12});
  EXPECT_EQ(report.status, SolveStatus::converged);
  // the rounded system, solved in double
  const Eigen::VectorXd of_rounded = test::dense(rounded).ldlt().solve(test::as_eigen(b));
  EXPECT_LT((test::as_eigen(x) - of_rounded).norm(), 1e-9 * of_rounded.norm());
  const Eigen::VectorXd exact = test::dense(matrix).ldlt().solve(test::as_eigen(b));
  EXPECT_LT((test::as_eigen(x) - exact).norm(), 1e-4 * exact.norm());
  EXPECT_GT((test::as_eigen(x) - exact).norm(), 1e-12 * exact.norm());
}

}  // namespace
}  // namespace meshorder
