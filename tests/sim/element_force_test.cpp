// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>

#include <gtest/gtest.h>
#include <sim/deformed.hpp>

namespace meshorder {
namespace {

AlignedVector<double> forces_of(const test::Patch& patch, const AlignedVector<double>& positions) {
  AlignedVector<double> forces(positions.size(), 0.0);
  add_stvk_forces(patch.rest, test::kSteel, positions, forces);
  return forces;
}

class StvkForces : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OfBarsMembranesSolids, StvkForces, testing::Values(1, 2, 3));

TEST_P(StvkForces, VanishAtRest) {
  const test::Patch patch = test::deformed_patch(GetParam(), 21);
  const AlignedVector<double> rest = padded_positions(patch.points);
  EXPECT_NEAR(stvk_energy(patch.rest, test::kSteel, rest), 0.0, 1e-24);
  EXPECT_LT(test::largest(forces_of(patch, rest)), 1e-13);
}

TEST_P(StvkForces, AreMinusTheGradientOfTheEnergy) {
  const test::Patch patch = test::deformed_patch(GetParam(), 21);
  AlignedVector<double> expected(patch.positions.size(), 0.0);
  AlignedVector<double> x = patch.positions;
  constexpr double kStep = 1e-5;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % kPaddedStride == 3) continue;
    x[i] = patch.positions[i] + kStep;
    const double above = stvk_energy(patch.rest, test::kSteel, x);
    x[i] = patch.positions[i] - kStep;
    const double below = stvk_energy(patch.rest, test::kSteel, x);
    x[i] = patch.positions[i];
    expected[i] = (below - above) / (2 * kStep);
  }
  test::expect_near(forces_of(patch, patch.positions), expected, 1e-8);
}

TEST_P(StvkForces, AreTheSameWithEveryInstructionSet) {
  for (const Index count : {1, 7, 8, 9, 101}) {
    const test::Patch patch = test::deformed_patch(GetParam(), count);
    AlignedVector<double> scalar(patch.positions.size(), 0.0);
    add_stvk_forces_scalar(patch.rest, test::kSteel, patch.positions, scalar);
    EXPECT_GT(test::largest(scalar), 0.01);
    test::for_each_target([&](const char* target) {
      SCOPED_TRACE(target);
      test::expect_near(forces_of(patch, patch.positions), scalar, 1e-12);
    });
  }
}

TEST_P(StvkForces, Balance) {
  const test::Patch patch = test::deformed_patch(GetParam(), 21);
  test::expect_balanced(forces_of(patch, patch.positions), patch.positions);
}

TEST_P(StvkForces, TurnWithTheBody) {
  const test::Patch patch = test::deformed_patch(GetParam(), 21);
  // a turn by an angle of cosine 0.6 about z, and an exchange of axes
  const auto turned = [](const AlignedVector<double>& v) {
    AlignedVector<double> result(v.size(), 0.0);
    for (std::size_t i = 0; i < v.size(); i += kPaddedStride) {
      result[i + 1] = 0.6 * v[i] - 0.8 * v[i + 1];
      result[i + 2] = 0.8 * v[i] + 0.6 * v[i + 1];
      result[i] = v[i + 2];
    }
    return result;
  };
  test::expect_near(forces_of(patch, turned(patch.positions)), turned(forces_of(patch, patch.positions)),
                    1e-13);
}

TEST_P(StvkForces, AddToWhatIsThere) {
  const test::Patch patch = test::deformed_patch(GetParam(), 21);
  const AlignedVector<double> once = forces_of(patch, patch.positions);
  AlignedVector<double> twice = once;
  add_stvk_forces(patch.rest, test::kSteel, patch.positions, twice);
  AlignedVector<double> expected = once;
  for (double& value : expected) value *= 2;
  test::expect_near(twice, expected, 1e-13);
}

TEST_P(StvkForces, RefusePositionsOfAnotherSize) {
  const test::Patch patch = test::deformed_patch(GetParam(), 3);
  AlignedVector<double> forces(patch.positions.size() - 4);
  EXPECT_THROW(add_stvk_forces(patch.rest, test::kSteel, patch.positions, forces), InvalidArgument);
}

TEST(StvkForcesOfABar, AreThoseOfUniaxialStretch) {
  const std::vector<Point> points{{0, 0, 0}, {2, 0, 0}};
  const RestShapes rest = rest_shapes({1, {0, 1}}, points);
  const AlignedVector<double> stretched{0, 0, 0, 0, 3, 0, 0, 0};
  AlignedVector<double> forces(8, 0.0);
  add_stvk_forces(rest, test::kSteel, stretched, forces);
  // stretch s = 1.5, strain ½(s² − 1), force (2μ + λ) · strain · s
  const double strain = 0.5 * (1.5 * 1.5 - 1);
  const double force = (2 * test::kSteel.mu + test::kSteel.lambda) * strain * 1.5;
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
  EXPECT_NEAR(stvk_energy(patch.rest, test::kSteel, x),
              volume * (3 * test::kSteel.mu + 4.5 * test::kSteel.lambda) * e * e, 1e-12 * volume);
}

TEST(StvkForcesOfFlatSimplices, AreNone) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0}};
  const RestShapes rest = rest_shapes({3, {0, 1, 2, 3, 0, 1, 1, 2}}, points);
  const AlignedVector<double> x =
      padded_positions(std::vector<Point>{{0, 0, 0}, {2, 0, 0}, {0, 1, 1}, {1, 5, 0}});
  AlignedVector<double> forces(16, 0.0);
  add_stvk_forces(rest, test::kSteel, x, forces);
  EXPECT_EQ(test::largest(forces), 0.0);
}

TEST(Lame, FollowsFromYoungsModulusAndPoissonsRatio) {
  const Lame lame = Lame::from_young(2.6, 0.3);
  EXPECT_NEAR(lame.mu, 1.0, 1e-15);
  EXPECT_NEAR(lame.lambda, 1.5, 1e-14);
}

}  // namespace
}  // namespace meshorder
