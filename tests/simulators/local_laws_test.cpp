// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/incidence.hpp"
#include "kernels/elasticity.hpp"
#include "kernels/springs.hpp"
#include "simulators/local_step.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

TEST(LocalEnergy, IsThatOfTheImplicitSimulator) {
  const test::Patch patch = test::tetrahedra(40);
  for (const double amplitude : {0.01, 0.3, 3.0}) {
    const AlignedVector<double> x = test::shaken(patch, 1, amplitude);
    for (const auto& [local, model] : std::vector<std::pair<LocalModel, MaterialModel>>{
             {LocalModel::stvk, MaterialModel::stvk},
             {LocalModel::neo_hookean, MaterialModel::neo_hookean}}) {
      LocalLaw law = test::law_of(local);
      Elasticity elasticity;
      elasticity.model = model;
      elasticity.lame = law.lame;
      const double expected = elastic_energy(patch.rest, elasticity, x);
      EXPECT_NEAR(test::steps_of(law, patch).energy(x), expected, 1e-11 * expected);
      // given one by one
      law.mu.assign(40, law.lame.mu);
      law.lambda.assign(40, law.lame.lambda);
      EXPECT_NEAR(test::steps_of(law, patch).energy(x), expected, 1e-11 * expected);
    }
  }
}

TEST(LocalSprings, AreThoseOnTheEdgesOfTheMesh) {
  const test::Patch patch = test::tetrahedra(40);
  const LocalLaw law = test::law_of(LocalModel::springs);
  const auto steps = test::steps_of(law, patch);
  Incidence incidence;
  incidence.vertex_count = index_size(patch.points);
  incidence.vertices = patch.simplices.vertices;
  incidence.offsets.resize(41);
  for (Offset s = 0; s <= 40; ++s) incidence.offsets[s] = 4 * s;
  const Springs springs = springs_on_edges(joined_vertices(incidence), patch.points);
  EXPECT_EQ(steps.element_count(), springs.count);
  const AlignedVector<double> x = test::shaken(patch, 1);
  const double expected = spring_energy(springs, law.stiffness, x);
  EXPECT_NEAR(steps.energy(x), expected, 1e-13 * expected);
}

TEST(LocalSprings, TakeAnyLength) {
  // a single tetrahedron: the first spring joins vertices 0 and 1
  const test::UnitTetrahedra body(1);
  for (const double length : {1e-320, 1e-200, 1e-30, 1.0, 1e30, 1e200, 1e300}) {
    LocalSteps<double> steps(test::law_of(LocalModel::springs), body.simplices, body.points);
    AlignedVector<double> x(16, 0.0);
    x[5] = -length;  // vertex 1 below vertex 0
    AlignedVector<double> sums = test::sums_for(steps);
    steps.pass(x, 1.0, sums);
    const std::vector<double> duals = steps.duals();
    // u = ½(q − ℓ₀ q/‖q‖)
    EXPECT_EQ(duals[0], 0.0);
    EXPECT_NEAR(duals[1], 0.5 * (length - 1.0), 1e-15 * std::max(1.0, length));
    EXPECT_EQ(duals[2], 0.0);
  }
}

TEST(LocalLaws, MayDifferFromTetrahedronToTetrahedron) {
  const test::Patch patch = test::tetrahedra(21);
  for (const LocalModel model : {LocalModel::strain, LocalModel::stvk, LocalModel::neo_hookean}) {
    LocalLaw soft = test::law_of(model, 0.2);
    LocalLaw hard = test::law_of(model, 0.4);
    hard.stiffness = 40.0;
    hard.lame.mu *= 10;
    hard.lame.lambda *= 10;
    LocalLaw both = soft;
    AlignedVector<double> expected(kPaddedStride * patch.points.size(), 0.0);
    const AlignedVector<double> x = test::shaken(patch, 0);
    for (Offset s = 0; s < 21; ++s) {
      const LocalLaw& law = s % 3 == 0 ? hard : soft;
      both.stiffnesses.push_back(law.stiffness);
      both.mu.push_back(law.lame.mu);
      both.lambda.push_back(law.lame.lambda);
      test::Patch alone = patch;
      alone.simplices.vertices.assign(patch.simplices.vertices.begin() + 4 * s,
                                      patch.simplices.vertices.begin() + 4 * s + 4);
      auto steps = test::steps_of(law, alone);
      AlignedVector<double> sums = test::sums_for(steps);
      steps.pass(x, 1.0, sums);
      for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += sums[i];
    }
    auto steps = test::steps_of(both, patch);
    AlignedVector<double> sums = test::sums_for(steps);
    steps.pass(x, 1.0, sums);
    test::expect_near({sums.data(), expected.size()}, expected, 1e-12);
  }
}

TEST(LocalLaws, OutOfRangeAreRefused) {
  const test::Patch patch = test::tetrahedra(3);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto refused = [&](const LocalLaw& law) {
    EXPECT_THROW(LocalSteps<double>(law, patch.simplices, patch.points), InvalidArgument);
    EXPECT_THROW(LocalSteps<float>(law, patch.simplices, patch.points), InvalidArgument);
  };
  for (const double bad : {0.0, -1.0, kNaN, kInfinity}) {
    for (const LocalModel model : {LocalModel::springs, LocalModel::strain}) {
      LocalLaw law = test::law_of(model);
      law.stiffness = bad;
      refused(law);
      law.stiffness = 1.0;
      law.stiffnesses = {1.0, 1.0, bad};
      refused(law);
    }
    for (const LocalModel model : {LocalModel::stvk, LocalModel::neo_hookean, LocalModel::log_neo_hookean}) {
      LocalLaw law = test::law_of(model);
      law.lame.mu = bad;
      refused(law);
      law = test::law_of(model);
      law.mu = {1.0, bad, 1.0};
      law.lambda = {1.0, 1.0, 1.0};
      refused(law);
    }
  }
  for (const double bad : {-1.0, kNaN, kInfinity, -kInfinity}) {
    LocalLaw law = test::law_of(LocalModel::neo_hookean);
    law.lame.lambda = bad;
    refused(law);
  }
  LocalLaw law = test::law_of(LocalModel::neo_hookean);
  law.mu = {1.0, 1.0, 1.0};
  refused(law);
  law.lambda = {1.0, 1.0};
  refused(law);
  law = test::law_of(LocalModel::strain);
  law.stiffnesses = {1.0};
  refused(law);
}

}  // namespace
}  // namespace meshorder
