// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/force_problem.hpp"

#include "base/random.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace meshorder {
namespace {

using Vector = Eigen::VectorXd;

Eigen::Map<const Vector> as_eigen(std::span<const double> vector) {
  return {vector.data(), static_cast<Eigen::Index>(vector.size())};
}

/// S as a dense matrix, preconditioned by its diagonal.
class DenseOperator final : public ForceOperator {
 public:
  explicit DenseOperator(Eigen::MatrixXd matrix) : matrix_(std::move(matrix)) {}
  void set(const Eigen::MatrixXd& matrix) { matrix_ = matrix; }

  void multiply(std::span<const double> forces, std::span<double> result) override {
    Eigen::Map<Vector>(result.data(), matrix_.rows()) = matrix_ * as_eigen(forces);
    ++multiplications;
  }
  void precondition(std::span<const double> moves, std::span<double> result) override {
    Eigen::Map<Vector>(result.data(), matrix_.rows()) = as_eigen(moves).cwiseQuotient(matrix_.diagonal());
  }
  [[nodiscard]] const Eigen::MatrixXd& matrix() const { return matrix_; }
  int multiplications = 0;

 private:
  Eigen::MatrixXd matrix_;
};

/// A problem with `normals` normal forces, discs for the first `discs` of them, and S of given rank and
/// spread.
struct Problem {
  DenseOperator matrix;
  ForceBounds bounds;
  Vector g;
  std::vector<double> scale;

  static Eigen::MatrixXd some_matrix(Index size, Index rank, double spread, Random& random) {
    Eigen::MatrixXd factor(rank, size);
    for (Index i = 0; i < rank; ++i) {
      for (Index j = 0; j < size; ++j)
        factor(i, j) = (random.unit() - 0.5) * std::pow(spread, -0.5 * static_cast<double>(i) / rank);
    }
    return factor.transpose() * factor;
  }

  Problem(Index normals, Index discs, Index rank, double spread, std::uint64_t seed)
      : Problem(normals, discs, rank, spread, Random(seed)) {}

 private:
  Problem(Index normals, Index discs, Index rank, double spread, Random random)
      : matrix(some_matrix(normals + 2 * discs, rank, spread, random)) {
    bounds.normals = normals;
    for (Index k = 0; k < discs; ++k) bounds.radii.push_back(k % 5 == 0 ? 0.0 : 3 * random.unit());
    // g is in the range of S, so the energy has a minimum for any rank
    Vector aim(normals + 2 * discs);
    for (double& a : aim) a = 8 * random.unit() - 3;
    g = matrix.matrix() * aim;
    scale.resize(static_cast<std::size_t>(aim.size()));
    Eigen::Map<Vector>(scale.data(), aim.size()) = matrix.matrix().diagonal();
  }

 public:
  [[nodiscard]] double energy(const Vector& forces) const {
    return 0.5 * forces.dot(matrix.matrix() * forces) - g.dot(forces);
  }
  /// Minimises by projected gradients with a safe step length.
  [[nodiscard]] Vector by_projected_gradients() const {
    const double step = 1.0 / matrix.matrix().selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
    std::vector<double> forces(static_cast<std::size_t>(g.size()), 0.0);
    Eigen::Map<Vector> x(forces.data(), g.size());
    for (int i = 0; i < 400'000; ++i) {
      const Vector before = x;
      x += step * (g - matrix.matrix() * x);
      project(bounds, forces);
      if ((x - before).norm() <= 1e-15 * x.norm()) break;
    }
    return x;
  }
};

struct Found {
  std::vector<double> forces, gradient;
  ForceSolveReport report;
};

Found minimise(Problem& problem, double tolerance, int multiplications, double start = 0.0,
               double softness = 0.0) {
  Found found;
  found.forces.assign(static_cast<std::size_t>(problem.g.size()), start);
  project(problem.bounds, found.forces);
  found.gradient.resize(found.forces.size());
  Eigen::Map<Vector>(found.gradient.data(), problem.g.size()) =
      problem.g - problem.matrix.matrix() * as_eigen(found.forces);
  problem.matrix.multiplications = 0;
  found.report = minimise_forces(problem.matrix, problem.bounds,
                                 {.tolerance = tolerance,
                                  .max_multiplications = multiplications,
                                  .scale = problem.scale,
                                  .softness = softness},
                                 found.forces, found.gradient);
  EXPECT_EQ(found.report.multiplications, problem.matrix.multiplications);
  EXPECT_LE(found.report.multiplications, multiplications);
  return found;
}

void expect_feasible(const ForceBounds& bounds, const std::vector<double>& forces) {
  for (Index k = 0; k < bounds.normals; ++k) EXPECT_GE(forces[k], 0.0);
  for (Index k = 0; k < index_size(bounds.radii); ++k) {
    const Index row = bounds.normals + 2 * k;
    EXPECT_LE(std::hypot(forces[row], forces[row + 1]), bounds.radii[k] * (1 + 1e-12));
  }
}

TEST(MinimiseForces, FindsTheLeastEnergyThatProjectedGradientsFind) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Problem problem(20, seed % 3 == 0 ? 0 : 12, 60, 30.0, seed);
    const Vector expected = problem.by_projected_gradients();
    for (const double start : {0.0, 5.0}) {
      const Found found = minimise(problem, 1e-10, 3000, start);
      EXPECT_LE(found.report.residual, 1e-10) << seed;
      expect_feasible(problem.bounds, found.forces);
      EXPECT_LE((as_eigen(found.forces) - expected).norm(), 1e-6 * expected.norm()) << seed;
      const Vector gradient = problem.g - problem.matrix.matrix() * as_eigen(found.forces);
      EXPECT_LE((as_eigen(found.gradient) - gradient).norm(), 1e-10 * problem.g.norm());
    }
  }
}

TEST(MinimiseForces, FindsALeastEnergyWhereSIsSingular) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Problem problem(30, seed % 2 == 0 ? 0 : 10, 12, 10.0, seed);
    // many minima exist; softness selects one of them
    const double size = problem.g.norm();
    const Found found = minimise(problem, 1e-8 * size, 5000, 0.0, 1e-9);
    EXPECT_LE(found.report.residual, 1e-8 * size) << seed;
    expect_feasible(problem.bounds, found.forces);
    const double expected = problem.energy(problem.by_projected_gradients());
    EXPECT_NEAR(problem.energy(as_eigen(found.forces)), expected, 1e-6 * std::abs(expected)) << seed;
  }
}

TEST(MinimiseForces, ConvergesWhereSIsIllConditioned) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Problem problem(60, 20, 300, 1e6, seed);
    const double size = problem.g.norm();
    const Found found = minimise(problem, 1e-8 * size, 100'000);
    EXPECT_LE(found.report.residual, 1e-8 * size) << seed;
    EXPECT_LE(found.report.multiplications, 2000) << seed;
  }
}

TEST(MinimiseForces, NeverEndsWithMoreEnergyThanItBeganWith) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Problem problem(40, 20, 90, 1e3, seed);
    double before = std::numeric_limits<double>::infinity();
    for (const int multiplications : {0, 1, 2, 3, 5, 8, 13, 21, 34}) {
      const Found found = minimise(problem, 0.0, multiplications, 1.0);
      const double energy = problem.energy(as_eigen(found.forces));
      if (multiplications == 0) before = energy;
      EXPECT_LE(energy, before + 1e-12 * std::abs(before)) << multiplications;
      expect_feasible(problem.bounds, found.forces);
    }
  }
}

TEST(MinimiseForces, NeedsNoMultiplicationsWhereItBegins) {
  Problem problem(20, 10, 60, 10.0, 4);
  const Found found = minimise(problem, 1e-9, 1000);
  std::vector<double> forces = found.forces;
  std::vector<double> gradient = found.gradient;
  const ForceSolveReport again = minimise_forces(
      problem.matrix, problem.bounds, {.tolerance = 1e-9, .max_multiplications = 10, .scale = problem.scale},
      forces, gradient);
  EXPECT_EQ(again.multiplications, 0);
  EXPECT_EQ(forces, found.forces);
}

TEST(MinimiseForces, EndsWithoutALeastEnergy) {
  // two contacts that contradict each other: S is singular and g outside of its range
  Problem problem(2, 0, 2, 1.0, 1);
  problem.matrix.set((Eigen::MatrixXd(2, 2) << 1, -1, -1, 1).finished());
  problem.g = Eigen::Vector2d(0.3, 0.3);
  problem.scale = {1.0, 1.0};
  const Found found = minimise(problem, 1e-9, 1000);
  EXPECT_GT(found.report.residual, 0.1);
  for (const double force : found.forces) EXPECT_TRUE(std::isfinite(force));
  // softness gives the energy a minimum
  std::vector<double> forces{0.0, 0.0};
  std::vector<double> gradient{0.3, 0.3};
  const ForceSolveReport soft = minimise_forces(
      problem.matrix, problem.bounds,
      {.tolerance = 1e-9, .max_multiplications = 1000, .scale = problem.scale, .softness = 1e-3}, forces,
      gradient);
  EXPECT_LE(soft.residual, 1e-9);
  EXPECT_NEAR(forces[0], 300.0, 1e-5);
  EXPECT_NEAR(forces[1], 300.0, 1e-5);
}

TEST(MinimiseForces, EndsWhereNumbersFail) {
  Problem problem(3, 2, 9, 1.0, 1);
  problem.g(1) = std::numeric_limits<double>::quiet_NaN();
  const Found found = minimise(problem, 1e-9, 1000);
  EXPECT_FALSE(found.report.residual <= 1e-9);
  EXPECT_LE(found.report.multiplications, 1);
}

}  // namespace
}  // namespace meshorder
