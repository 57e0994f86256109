// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "elastic_system.hpp"
#include "kernels/block_csr.hpp"
#include "lab/linear/cg/solve.hpp"
#include "lab/linear/preconditioners/preconditioner.hpp"
#include "mesh/procedural.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

/// ‖b − A x‖ / ‖b‖
double residual(const BlockCsr& matrix, const std::vector<double>& b, const std::vector<double>& x) {
  std::vector<double> product(b.size());
  multiply(matrix, x, product);
  return (test::as_eigen(b) - test::as_eigen(product)).norm() / test::as_eigen(b).norm();
}

/// A system for which rounding to float leaves a residual far above the tolerances of the tests.
struct Stiff {
  Mesh mesh = make_grid({.size = 6});
  BlockCsr matrix = test::elastic_system(mesh, 1e-2);
  BlockCsrOf<float> rounded;
  HalfBlockCsrOf<float> rounded_half;
  std::unique_ptr<Preconditioner> jacobi =
      make_preconditioner(PreconditionerKind::jacobi, matrix, mesh.points);
  std::vector<double> b = test::random_vector(matrix.size(), 3);
  std::vector<double> x = std::vector<double>(b.size());

  Stiff() {
    round_to_single(matrix, rounded);
    store_half(matrix, rounded_half);
    jacobi->update(matrix);
  }
};

TEST(Refinement, ReachesResidualsThatTheRoundedMatrixCannot) {
  Stiff system;
  const auto expect_residual = [&](const auto& rounded, double tolerance) {
    SolveOptions options;
    options.tolerance = tolerance;
    std::fill(system.x.begin(), system.x.end(), 0.0);
    const SolveReport report =
        refined_conjugate_gradients(system.matrix, rounded, *system.jacobi, system.b, system.x, options);
    EXPECT_EQ(report.status, SolveStatus::converged);
    EXPECT_LE(report.residual, tolerance);
    EXPECT_LE(residual(system.matrix, system.b, system.x), 1.01 * tolerance);
  };
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    expect_residual(system.rounded, tolerance);
    expect_residual(system.rounded_half, tolerance);
  }
  Stiff alone;
  SolveOptions options;
  options.tolerance = 1e-12;
  conjugate_gradients(alone.rounded, *alone.jacobi, alone.b, alone.x, options);
  EXPECT_GT(residual(alone.matrix, alone.b, alone.x), 1e-10);
}

TEST(Refinement, TakesTheStartIntoAccount) {
  Stiff system;
  SolveOptions options;
  options.tolerance = 1e-12;
  refined_conjugate_gradients(system.matrix, system.rounded, *system.jacobi, system.b, system.x, options);
  options.tolerance = 0.5;
  const std::vector<double> before = system.x;
  const SolveReport report =
      refined_conjugate_gradients(system.matrix, system.rounded, *system.jacobi, system.b, system.x, options);
  EXPECT_LE(report.residual, 0.5);
  EXPECT_LT((test::as_eigen(system.x) - test::as_eigen(before)).norm(), 1e-8 * test::as_eigen(before).norm());
}

TEST(Refinement, CountsAllIterationsAgainstTheLimit) {
  Stiff system;
  SolveOptions options;
  options.tolerance = 1e-12;
  options.max_iterations = 40;
  const SolveReport report =
      refined_conjugate_gradients(system.matrix, system.rounded, *system.jacobi, system.b, system.x, options);
  EXPECT_EQ(report.status, SolveStatus::iteration_limit);
  EXPECT_EQ(report.iterations, 40);
  EXPECT_GE(report.vertex, 0);
}

TEST(Refinement, NothingToSolveIsSolved) {
  Stiff system;
  std::fill(system.b.begin(), system.b.end(), 0.0);
  const SolveReport report =
      refined_conjugate_gradients(system.matrix, system.rounded, *system.jacobi, system.b, system.x);
  EXPECT_EQ(report.status, SolveStatus::converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.residual, 0.0);
}

}  // namespace
}  // namespace meshorder
