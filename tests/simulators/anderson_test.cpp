// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/anderson.hpp"

#include "base/error.hpp"
#include "base/random.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace meshorder {
namespace {

using Map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// x after so many mixed steps, the vector in two parts.
template <class Real = double>
Eigen::VectorXd iterate(AndersonMixer<Real>& mixer, const Map& g, const Eigen::VectorXd& start, int steps) {
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  Vector x = start.cast<Real>();
  const auto size = static_cast<std::size_t>(x.size());
  const std::size_t split = size / 3;
  for (int step = 0; step < steps; ++step) {
    Vector mapped = g(x.template cast<double>()).template cast<Real>();
    const std::span<const Real> from(x.data(), size);
    const std::span<Real> to(mapped.data(), size);
    mixer.mix(std::array{from.first(split), from.subspan(split)},
              std::array{to.first(split), to.subspan(split)});
    x = mapped;
  }
  return x.template cast<double>();
}

Eigen::VectorXd random_vector(Eigen::Index n, std::uint64_t seed = 1) {
  Random random(seed);
  return Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return random.unit() - 0.5; });
}

/// g(x) = x + b − A x with A symmetric, of k eigenvalues, each many times; and the fixed point.
struct Linear {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd b;
  Eigen::VectorXd solution;

  Linear(Eigen::Index n, int eigenvalues, double least, double largest) : b(random_vector(n, 5)) {
    const Eigen::VectorXd any = random_vector(n * n, 4);
    const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(any.reshaped(n, n)).householderQ();
    const Eigen::VectorXd values = Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index i) {
      return least + (largest - least) * static_cast<double>(i % eigenvalues) / std::max(1, eigenvalues - 1);
    });
    matrix = q * values.asDiagonal() * q.transpose();
    solution = q * values.cwiseInverse().asDiagonal() * q.transpose() * b;
  }
  [[nodiscard]] Map map() const {
    return [this](const Eigen::VectorXd& x) -> Eigen::VectorXd { return x + b - matrix * x; };
  }
  [[nodiscard]] double error(const Eigen::VectorXd& x) const {
    return (x - solution).norm() / solution.norm();
  }
};

TEST(AndersonMixer, SolvesALinearProblemOfKDimensionsInKPlusOneSteps) {
  // Krylov spaces of k eigenvalues have k dimensions: with k earlier steps the residual vanishes
  for (const int k : {1, 2, 3, 5, 8}) {
    const Linear problem(60, k, 0.5, 3.0);
    AndersonMixer<double> mixer(10);
    const Eigen::VectorXd start = random_vector(60);
    EXPECT_LT(problem.error(iterate(mixer, problem.map(), start, k + 1)), 1e-7) << k << " eigenvalues";
    if (k == 1) continue;
    AndersonMixer<double> too_few(10);
    EXPECT_GT(problem.error(iterate(too_few, problem.map(), start, k)), 1e-4) << k << " eigenvalues";
  }
}

TEST(AndersonMixer, ConvergesFastWherePlainIterationNeedsHundredsOfSteps) {
  // plain iteration keeps 1 − 0.01 of the error at each step
  const Linear problem(200, 200, 0.01, 1.0);
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(200);
  Eigen::VectorXd plain = start;
  for (int step = 0; step < 300; ++step) plain = problem.map()(plain);
  EXPECT_GT(problem.error(plain), 1e-2);
  AndersonMixer<double> mixer(8);
  EXPECT_LT(problem.error(iterate(mixer, problem.map(), start, 100)), 1e-3);
}

TEST(AndersonMixer, AcceleratesANonlinearContraction) {
  const auto g = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return x.unaryExpr([](double value) { return 0.98 * std::sin(value) + 0.02; }) +
           0.01 * Eigen::VectorXd::Constant(x.size(), x.mean());
  };
  const auto residual = [&](const Eigen::VectorXd& x) { return (g(x) - x).norm(); };
  const Eigen::VectorXd start = random_vector(50);
  Eigen::VectorXd plain = start;
  for (int step = 0; step < 40; ++step) plain = g(plain);
  AndersonMixer<double> mixer(5);
  const Eigen::VectorXd mixed = iterate(mixer, g, start, 40);
  EXPECT_LT(residual(mixed), 1e-4 * residual(plain));
}

TEST(AndersonMixer, WorksInSinglePrecision) {
  const Linear problem(60, 4, 0.5, 3.0);
  AndersonMixer<float> mixer(6);
  EXPECT_LT(problem.error(iterate<float>(mixer, problem.map(), random_vector(60), 12)), 1e-5);
}

TEST(AndersonMixer, StaysAtAFixedPoint) {
  const Linear problem(30, 3, 0.5, 2.0);
  AndersonMixer<double> mixer;
  const Eigen::VectorXd x = iterate(
      mixer, [](const Eigen::VectorXd& y) { return y; }, problem.solution, 7);
  EXPECT_EQ(x, problem.solution);
  EXPECT_EQ(mixer.residual(), 0.0);
}

TEST(AndersonMixer, BearsResidualsThatNoLongerDiffer) {
  // long after convergence steps are rounding errors, and before it they are all in the same two directions
  const Linear problem(40, 2, 0.5, 2.0);
  AndersonMixer<double> mixer(10);
  Eigen::VectorXd x = iterate(mixer, problem.map(), random_vector(40), 4);
  for (int step = 0; step < 300; ++step) {
    x = iterate(mixer, problem.map(), x, 1);
    EXPECT_LT(mixer.residual(), 1e-10) << step;
  }
  EXPECT_LT(problem.error(x), 1e-13);
}

TEST(AndersonMixer, DoesNotExtrapolateRoundingErrors) {
  // the first half has converged; the others go on for ever, and their residuals do not change
  const auto g = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    Eigen::VectorXd result = 0.3 * x + Eigen::VectorXd::Ones(x.size());
    result.tail(x.size() / 2) = x.tail(x.size() / 2).array() + 1e-3;
    return result;
  };
  AndersonMixer<double> mixer(5);
  EXPECT_LT(iterate(mixer, g, random_vector(20), 100).cwiseAbs().maxCoeff(), 2.0);
  AndersonMixer<float> single(5);
  EXPECT_LT(iterate<float>(single, g, random_vector(20), 100).cwiseAbs().maxCoeff(), 2.0);
}

TEST(AndersonMixer, ChoosesTheLeastWeightsWhereStepsAreAlike) {
  // residuals differ along one direction alone, in any order; the others stay large
  const Eigen::VectorXd direction = random_vector(20, 2);
  Random random(6);
  const auto g = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    Eigen::VectorXd residual = random.unit() * direction;
    residual.tail(10).array() = 10;
    return x + residual;
  };
  AndersonMixer<double> mixer(8);
  // chance residuals make large steps; weights that are rounding errors over rounding errors make 1e19
  EXPECT_LT(iterate(mixer, g, Eigen::VectorXd::Zero(20), 40).cwiseAbs().maxCoeff(), 1e9);
}

TEST(AndersonMixer, TakesAPlainStepAfterAReset) {
  const Linear problem(30, 30, 0.1, 1.5);
  AndersonMixer<double> mixer(3);
  const Eigen::VectorXd x = iterate(mixer, problem.map(), random_vector(30), 6);
  EXPECT_EQ(mixer.depth(), 3);
  mixer.reset();
  EXPECT_EQ(mixer.depth(), 0);
  EXPECT_EQ(iterate(mixer, problem.map(), x, 1), problem.map()(x));
  EXPECT_DOUBLE_EQ(mixer.residual(), (problem.map()(x) - x).norm());
  // and knows nothing of what was before it
  AndersonMixer<double> other(3);
  EXPECT_EQ(iterate(mixer, problem.map(), problem.map()(x), 5),
            (iterate(other, problem.map(), x, 1), iterate(other, problem.map(), problem.map()(x), 5)));
}

TEST(AndersonMixer, LeavesWhatIsNotFiniteAndStartsAnew) {
  AndersonMixer<double> mixer;
  const Linear problem(9, 3, 0.5, 2.0);
  const Eigen::VectorXd x = iterate(mixer, problem.map(), random_vector(9), 3);
  const auto broken = [](const Eigen::VectorXd& y) -> Eigen::VectorXd {
    Eigen::VectorXd result = y;
    result[4] = std::numeric_limits<double>::infinity();
    return result;
  };
  EXPECT_EQ(iterate(mixer, broken, x, 1), broken(x));
  EXPECT_EQ(mixer.depth(), 0);
  EXPECT_EQ(iterate(mixer, broken, x, 1), broken(x));
  EXPECT_EQ(iterate(mixer, problem.map(), x, 1), problem.map()(x));
  EXPECT_LT(problem.error(iterate(mixer, problem.map(), problem.map()(x), 3)), 1e-7);
}

TEST(AndersonMixer, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Eigen::VectorXd factors = random_vector(50'000).cwiseAbs();
  const auto g = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return factors.cwiseProduct(x) + Eigen::VectorXd::Ones(x.size());
  };
  Eigen::VectorXd first;
  for (const std::size_t threads : {1, 2, 3, 5}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    AndersonMixer<double> mixer(4);
    const Eigen::VectorXd x = iterate(mixer, g, Eigen::VectorXd::Zero(50'000), 8);
    if (threads == 1) first = x;
    EXPECT_EQ(x, first) << threads << " threads";
  }
}

TEST(AndersonMixer, RefusesWindowsAndPartsThatDoNotFit) {
  EXPECT_THROW(AndersonMixer<double>(0), InvalidArgument);
  EXPECT_THROW(AndersonMixer<double>(11), InvalidArgument);
  AndersonMixer<double> mixer;
  std::vector<double> three(3), four(4);
  using In = std::vector<std::span<const double>>;
  using Out = std::vector<std::span<double>>;
  EXPECT_THROW(mixer.mix(In{three}, Out{four}), InvalidArgument);
  EXPECT_THROW(mixer.mix(In{three, four}, Out{three}), InvalidArgument);
  mixer.mix(In{three}, Out{three});
  EXPECT_THROW(mixer.mix(In{four}, Out{four}), InvalidArgument);
  mixer.reset();
  mixer.mix(In{four}, Out{four});
  EXPECT_GE(mixer.bytes(), 12 * 4 * sizeof(double));
}

}  // namespace
}  // namespace meshorder
