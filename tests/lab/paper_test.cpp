// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/paper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using namespace meshorder;

/// Half a unit of the last printed digit.
double half_unit(double printed) {
  for (const double unit : {1.0, 0.1, 0.01}) {
    if (std::abs(printed / unit - std::round(printed / unit)) < 1e-6) return unit / 2;
  }
  return 0.0005;
}

TEST(Paper, SecondsAndPercentOfAScenarioTellOfOneScrambledTime) {
  ASSERT_EQ(paper_scenarios().size(), 6);
  for (const PaperScenario& scenario : paper_scenarios()) {
    const double scrambled = *paper_seconds(scenario.name, "scrambled");
    for (const PaperSaving& saving : scenario.savings) {
      // the range of the printed digits, and half a per cent for the rounding of the sum
      const double seconds = half_unit(saving.seconds);
      const double percent = half_unit(saving.percent);
      EXPECT_GT(scrambled, 0.995 * 100 * (saving.seconds - seconds) / (saving.percent + percent))
          << scenario.name << ", " << saving.ordering;
      EXPECT_LT(scrambled, 1.005 * 100 * (saving.seconds + seconds) / (saving.percent - percent))
          << scenario.name << ", " << saving.ordering;
    }
  }
}

// times that the project's notes derive from one caption each
TEST(Paper, DerivedTimesAgreeWithThoseOfItsFirstCaptions) {
  EXPECT_NEAR(*paper_seconds("falling", "scrambled"), 1844, 6);
  EXPECT_NEAR(*paper_seconds("constrained", "scrambled"), 2205, 6);
  EXPECT_NEAR(*paper_seconds("stretch", "scrambled"), 425, 2);
  EXPECT_NEAR(*paper_seconds("unsquash", "scrambled"), 2320, 6);
  EXPECT_NEAR(*paper_seconds("bowl", "scrambled"), 4330, 20);
  EXPECT_NEAR(*paper_seconds("bounce", "scrambled"), 3200, 20);
  EXPECT_NEAR(*paper_seconds("falling", "vf-fiedler"), 1846 - 514, 1);
}

TEST(Paper, SaysNothingThatItsTextDoesNotHold) {
  EXPECT_FALSE(paper_saving("falling", "vf-scrambled"));
  EXPECT_FALSE(paper_saving("falling", "scrambled"));
  EXPECT_FALSE(paper_seconds("falling", "vf-scrambled"));
  EXPECT_FALSE(paper_seconds("mine", "scrambled"));
  EXPECT_EQ(find_paper_scenario("mine"), nullptr);
  EXPECT_EQ(find_paper_scenario("bowl")->figure, "Figure 8");
  EXPECT_EQ(paper_saving("bowl", "vf-fiedler")->percent, 10.4);
}

}  // namespace
