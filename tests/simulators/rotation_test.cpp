// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/rotation.hpp"

#include "payoff/elastic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace meshorder {
namespace {

Eigen::Matrix3d rotation_of(const Eigen::Matrix3d& f) {
  Matrix3 from{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) from[i][j] = f(i, j);
  }
  const Matrix3 to = closest_rotation(from);
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result(i, j) = to[i][j];
  }
  return result;
}

/// By another library's singular values: U diag(1, 1, ±1) Vᵀ.
Eigen::Matrix3d expected_rotation(const Eigen::Matrix3d& f) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

void expect_rotation(const Eigen::Matrix3d& r) {
  EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 3e-13) << r;
  EXPECT_NEAR(r.determinant(), 1.0, 3e-13);
}

TEST(ClosestRotation, IsThatOfTheSingularValueDecomposition) {
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    // all magnitudes and ratios, a third of them inverted
    const double large = std::pow(10.0, 6 * random.unit() - 3);
    const double middle = large * std::pow(random.unit(), 1 + i % 4);
    const double small = middle * (i % 3 == 0 ? -0.9 : 1.0) * std::pow(random.unit(), 1 + i % 5);
    const test::State state{"", {large, middle, small}};
    const Eigen::Matrix3d f = test::gradient_of(state, random.below(1U << 30U));
    const Eigen::Matrix3d r = rotation_of(f);
    expect_rotation(r);
    const double condition = large / (middle + small);
    ASSERT_LT((r - expected_rotation(f)).cwiseAbs().maxCoeff(), std::max(1e-12, 5e-15 * condition))
        << state.sigma.transpose();
  }
}

TEST(ClosestRotation, ExistsWhereItIsNotUnique) {
  for (const test::State& state : test::states()) {
    SCOPED_TRACE(state.name);
    const Eigen::Matrix3d f = test::gradient_of(state);
    const Eigen::Matrix3d r = rotation_of(f);
    expect_rotation(r);
    // no rotation is closer to f
    EXPECT_NEAR((r.array() * f.array()).sum(), state.sigma.sum(), 1e-14 * (1.0 + state.sigma.sum()));
  }
  EXPECT_EQ(rotation_of(Eigen::Matrix3d::Zero()), Eigen::Matrix3d::Identity());
  expect_rotation(rotation_of(-Eigen::Matrix3d::Identity()));
}

TEST(ClosestRotation, DoesNotSeeTheScale) {
  const Eigen::Matrix3d f = test::gradient_of({"", {1.2, 0.9, -0.3}});
  const Eigen::Matrix3d r = rotation_of(f);
  for (const double scale : {1e-320, 1e-300, 1e-160, 1e-100, 1e-61, 1e-30, 1e30, 1e70, 1e80, 1e160, 1e307}) {
    // the part of f that denormals can represent
    const double tolerance = scale < 1e-310 ? 1e-2 : 1e-12;
    EXPECT_LT((rotation_of(scale * f) - r).cwiseAbs().maxCoeff(), tolerance) << scale;
  }
}

TEST(ClosestRotation, EndsWithNaNForWhatIsNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (int k = 0; k < 9; ++k) {
      Eigen::Matrix3d f = test::gradient_of({"", {1.2, 0.9, 0.3}});
      f(k / 3, k % 3) = bad;
      EXPECT_TRUE(rotation_of(f).array().isNaN().all()) << k;
    }
  }
}

}  // namespace
}  // namespace meshorder
