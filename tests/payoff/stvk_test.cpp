// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/elastic.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

using test::kSteel;

const Elasticity kStvk{MaterialModel::stvk, Tangent::exact, kSteel, {}, {}};

Eigen::MatrixXd edges(const Index* corner, int d, const std::vector<Point>& points) {
  Eigen::MatrixXd result(3, d);
  for (int a = 0; a < d; ++a) {
    for (int c = 0; c < 3; ++c) result(c, a) = points[corner[a + 1]][c] - points[corner[0]][c];
  }
  return result;
}

/// The Hessian column by column, from the variation of the stress with each coordinate of each corner. The
/// rest frame differs from the kernel's.
Eigen::MatrixXd dense_stiffness(const test::Patch& patch) {
  const int d = patch.simplices.dimension;
  std::vector<Point> deformed(patch.points.size());
  for (std::size_t v = 0; v < deformed.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) deformed[v][c] = patch.positions[kPaddedStride * v + c];
  }
  const auto n = static_cast<Eigen::Index>(3 * deformed.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Offset s = 0; s < patch.simplices.size(); ++s) {
    const Index* const corner = patch.simplices.vertices.data() + (d + 1) * s;
    const Eigen::MatrixXd rest = edges(corner, d, patch.points);
    const Eigen::MatrixXd metric = rest.transpose() * rest;
    // a square root of the metric is the edge matrix in some orthonormal frame
    const Eigen::MatrixXd inverse =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(metric).operatorInverseSqrt();
    const double volume = std::sqrt(metric.determinant()) / (d == 3 ? 6 : d);
    const Eigen::MatrixXd f = edges(corner, d, deformed) * inverse;
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(d, d);
    const auto stress = [&](const Eigen::MatrixXd& strain) -> Eigen::MatrixXd {
      return 2 * kSteel.mu * strain + kSteel.lambda * strain.trace() * identity;
    };
    Eigen::MatrixXd g(d + 1, d);
    g << -inverse.colwise().sum(), inverse;
    for (int b = 0; b <= d; ++b) {
      for (int k = 0; k < 3; ++k) {
        const Eigen::MatrixXd df = Eigen::Vector3d::Unit(k) * g.row(b);
        const Eigen::MatrixXd dp = df * stress(0.5 * (f.transpose() * f - identity)) +
                                   f * stress(0.5 * (df.transpose() * f + f.transpose() * df));
        for (int a = 0; a <= d; ++a) {
          result.block<3, 1>(3 * corner[a], 3 * corner[b] + k) += volume * dp * g.row(a).transpose();
        }
      }
    }
  }
  return result;
}

class StvkStiffness : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OfBarsMembranesSolids, StvkStiffness, testing::Values(1, 2, 3));

TEST_P(StvkStiffness, EqualsTheDenseOneWithEveryInstructionSet) {
  for (const Index count : {1, 8, 19}) {
    const test::Patch patch = test::deformed_patch(GetParam(), count);
    const Eigen::MatrixXd expected = dense_stiffness(patch);
    test::for_each_target([&](const char* target) {
      SCOPED_TRACE(target);
      const Eigen::MatrixXd actual = test::dense_stiffness(patch, kStvk, patch.positions);
      EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
    });
  }
}

TEST(StvkForcesOfABar, AreThoseOfUniaxialStretch) {
  const std::vector<Point> points{{0, 0, 0}, {2, 0, 0}};
  const RestShapes rest = rest_shapes(Simplices{1, {0, 1}, {}}, points);
  const AlignedVector<double> stretched{0, 0, 0, 0, 3, 0, 0, 0};
  AlignedVector<double> forces(8, 0.0);
  add_elasticity(rest, kStvk, stretched, forces, nullptr);
  // stretch s = 1.5, strain ½(s² − 1), force (2μ + λ) · strain · s
  const double strain = 0.5 * (1.5 * 1.5 - 1);
  const double force = (2 * kSteel.mu + kSteel.lambda) * strain * 1.5;
  EXPECT_NEAR(forces[0], force, 1e-14);
  EXPECT_NEAR(forces[4], -force, 1e-14);
  EXPECT_EQ(forces[5], 0.0);
}

TEST(StvkEnergy, OfADilatedSolidIsItsClosedForm) {
  const test::Patch patch = test::deformed_patch(3, 10);
  AlignedVector<double> x = padded_positions(patch.points);
  for (double& value : x) value *= 1.1;
  double volume = 0.0;
  for (Offset s = 0; s < 10; ++s) volume += patch.rest.geometry[(s / kBatch * 7 + 6) * kBatch + s % kBatch];
  const double e = 0.5 * (1.1 * 1.1 - 1);
  EXPECT_NEAR(elastic_energy(patch.rest, kStvk, x), volume * (3 * kSteel.mu + 4.5 * kSteel.lambda) * e * e,
              1e-12 * volume);
}

TEST(Lame, FollowsFromYoungsModulusAndPoissonsRatio) {
  const Lame lame = Lame::from_young(2.6, 0.3);
  EXPECT_NEAR(lame.mu, 1.0, 1e-15);
  EXPECT_NEAR(lame.lambda, 1.5, 1e-14);
}

}  // namespace
}  // namespace meshorder
