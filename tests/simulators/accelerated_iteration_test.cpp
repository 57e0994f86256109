// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/accelerated_iteration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace meshorder {
namespace {

using Vector = std::vector<double>;

/// What becomes of positions and duals that an iteration maps like this.
struct Iterate {
  Vector positions, duals;
};

void step(AcceleratedIteration<double>& iteration, Iterate& at, const Iterate& mapped) {
  iteration.begin(at.positions, at.duals);
  at = mapped;
  iteration.finish(at.positions, at.duals);
}

TEST(AcceleratedIteration, SolvesALinearProblemOfTwoNumbersInThreeSteps) {
  // the fixed point of x ← 0.9 x + 0.1 and u ← −0.8 u + 3.6 is 1, 2
  const auto mapped = [](const Iterate& at) {
    return Iterate{{0.9 * at.positions[0] + 0.1}, {-0.8 * at.duals[0] + 3.6}};
  };
  AcceleratedIteration<double> iteration(5);
  Iterate at{{0.0}, {0.0}};
  for (int k = 0; k < 3; ++k) step(iteration, at, mapped(at));
  EXPECT_NEAR(at.positions[0], 1.0, 1e-9);
  EXPECT_NEAR(at.duals[0], 2.0, 1e-9);
}

TEST(AcceleratedIteration, GoesBackWhereAMixedIterateIsWorse) {
  AcceleratedIteration<double> iteration(5);
  Iterate at{{0.0}, {0.0}};
  step(iteration, at, {{1.0}, {0.0}});  // the first one is taken as it is
  EXPECT_EQ(at.positions, Vector{1.0});
  step(iteration, at, {{1.5}, {0.25}});
  const Iterate mixed = at;
  EXPECT_NE(mixed.positions, Vector{1.5});
  // it is mapped far away: back to what the one before was mapped to
  step(iteration, at, {{mixed.positions[0] + 10}, {mixed.duals[0]}});
  EXPECT_EQ(at.positions, Vector{1.5});
  EXPECT_EQ(at.duals, Vector{0.25});
  // and what was seen is forgotten: the next one is taken as it is
  step(iteration, at, {{7.0}, {8.0}});
  EXPECT_EQ(at.positions, Vector{7.0});
  EXPECT_EQ(at.duals, Vector{8.0});
}

TEST(AcceleratedIteration, ForgetsOnReset) {
  AcceleratedIteration<double> iteration(5);
  Iterate at{{0.0}, {0.0}};
  step(iteration, at, {{1.0}, {0.0}});
  iteration.reset();
  step(iteration, at, {{100.0}, {100.0}});
  EXPECT_EQ(at.positions, Vector{100.0});
}

TEST(AcceleratedIteration, LeavesWhatIsNotFinite) {
  AcceleratedIteration<double> iteration(5);
  Iterate at{{0.0}, {0.0}};
  step(iteration, at, {{1.0}, {0.0}});
  step(iteration, at, {{std::numeric_limits<double>::quiet_NaN()}, {0.5}});
  EXPECT_TRUE(std::isnan(at.positions[0]));
  EXPECT_EQ(at.duals, Vector{0.5});
}

}  // namespace
}  // namespace meshorder
