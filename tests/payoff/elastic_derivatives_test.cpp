// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/elastic.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

using test::Case;
using test::elasticity_of;
using test::forces_of;

constexpr double kStep = 1e-5;

AlignedVector<double> minus_gradient(const test::Patch& patch, const Elasticity& elasticity,
                                     const AlignedVector<double>& positions) {
  AlignedVector<double> result(positions.size(), 0.0);
  AlignedVector<double> x = positions;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % kPaddedStride == 3) continue;
    x[i] = positions[i] + kStep;
    const double above = elastic_energy(patch.rest, elasticity, x);
    x[i] = positions[i] - kStep;
    const double below = elastic_energy(patch.rest, elasticity, x);
    x[i] = positions[i];
    result[i] = (below - above) / (2 * kStep);
  }
  return result;
}

Eigen::MatrixXd minus_jacobian(const test::Patch& patch, const Elasticity& elasticity,
                               const AlignedVector<double>& positions) {
  const auto n = static_cast<Eigen::Index>(3 * patch.points.size());
  Eigen::MatrixXd result(n, n);
  AlignedVector<double> x = positions;
  for (Index column = 0; column < n; ++column) {
    const Index entry = kPaddedStride * (column / 3) + column % 3;
    x[entry] = positions[entry] + kStep;
    const AlignedVector<double> above = forces_of(patch, elasticity, x);
    x[entry] = positions[entry] - kStep;
    const AlignedVector<double> below = forces_of(patch, elasticity, x);
    x[entry] = positions[entry];
    for (Index row = 0; row < n; ++row) {
      const Index place = kPaddedStride * (row / 3) + row % 3;
      result(row, column) = (below[place] - above[place]) / (2 * kStep);
    }
  }
  return result;
}

class ElasticDerivatives : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(OfAll, ElasticDerivatives,
                         testing::Values(Case{MaterialModel::corotational, Tangent::exact},
                                         Case{MaterialModel::stvk, Tangent::exact},
                                         Case{MaterialModel::stvk, Tangent::exact, 2},
                                         Case{MaterialModel::stvk, Tangent::exact, 1},
                                         Case{MaterialModel::neo_hookean, Tangent::exact}),
                         test::case_name);

TEST_P(ElasticDerivatives, OfTheEnergyAreMinusTheForces) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 21);
  const Elasticity elasticity = elasticity_of(GetParam());
  test::expect_near(forces_of(patch, elasticity, patch.positions),
                    minus_gradient(patch, elasticity, patch.positions), 1e-8);
  for (const test::State& state : test::states()) {
    SCOPED_TRACE(state.name);
    if (!state.smooth && GetParam().model == MaterialModel::corotational) continue;
    const AlignedVector<double> x = test::mapped(patch.points, test::gradient_of(state));
    const AlignedVector<double> forces = forces_of(patch, elasticity, x);
    const AlignedVector<double> expected = minus_gradient(patch, elasticity, x);
    const double tolerance = 1e-8 * (1.0 + test::largest(expected));
    for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(forces[i], expected[i], tolerance) << i;
  }
}

TEST_P(ElasticDerivatives, OfTheForcesAreMinusTheStiffness) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 19);
  const Elasticity elasticity = elasticity_of(GetParam());
  const auto expect_derivative = [&](const AlignedVector<double>& x) {
    const Eigen::MatrixXd expected = minus_jacobian(patch, elasticity, x);
    EXPECT_LT((test::dense_stiffness(patch, elasticity, x) - expected).cwiseAbs().maxCoeff(),
              2e-8 * (1.0 + expected.cwiseAbs().maxCoeff()));
  };
  expect_derivative(patch.positions);
  for (const test::State& state : test::states()) {
    SCOPED_TRACE(state.name);
    if (!state.smooth && GetParam().model == MaterialModel::corotational) continue;
    expect_derivative(test::mapped(patch.points, test::gradient_of(state)));
  }
}

}  // namespace
}  // namespace meshorder
