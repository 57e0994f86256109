// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/study_turns.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

StepperReady body_of(double step_seconds, Index vertices = 40'000, Offset bytes = 100'000'000) {
  StepperReady body;
  body.vertices = vertices;
  body.step_seconds = step_seconds;
  body.bytes = bytes;
  return body;
}

TEST(StudyTurns, LastAboutASecondAndHoldWholeFrames) {
  const TurnPlan slow = plan_turns(body_of(0.4), 240, {}, 5);
  EXPECT_EQ(slow.steps, 240);
  EXPECT_EQ(slow.frame_every, 5);  // 48 frames
  EXPECT_EQ(slow.turn, 5);
  const TurnPlan quick = plan_turns(body_of(0.04), 240, {}, 5);
  EXPECT_EQ(quick.turn, 25);
  EXPECT_TRUE(quick.interleaved);
}

TEST(StudyTurns, AreEightAtLeastWhereTheStepsSuffice) {
  EXPECT_EQ(plan_turns(body_of(1e-5), 240, {}, 5).turn, 30);
  EXPECT_EQ(plan_turns(body_of(1e-5), 3, {}, 5).turn, 1);
  EXPECT_EQ(plan_turns(body_of(0), 240, {}, 5).turn, 30);
}

TEST(StudyTurns, KeepFewerFramesOfLargeBodies) {
  const TurnPlan plan = plan_turns(body_of(5, 2'000'000), 240, {}, 5);
  EXPECT_LE(Offset{12} * 2'000'000 * (plan.steps / plan.frame_every), Offset{256} << 20);
  EXPECT_GE(plan.steps / plan.frame_every, 8);
}

TEST(StudyTurns, TakeAsManyStepsAsTheTimeAllows) {
  EXPECT_EQ(plan_turns(body_of(0.1), 240, 20.0, 5).steps, 40);
  EXPECT_EQ(plan_turns(body_of(10), 240, 20.0, 5).steps, 8);  // the least number
  EXPECT_EQ(plan_turns(body_of(10), 4, 20.0, 5).steps, 4);
  EXPECT_EQ(plan_turns(body_of(1e-4), 240, 20.0, 5).steps, 240);
}

TEST(StudyTurns, FollowOneAnotherWhereMemoryDoesNotHoldAllOrders) {
  EXPECT_FALSE(plan_turns(body_of(1, 1000, Offset{1} << 50), 240, {}, 5).interleaved);
}

}  // namespace
}  // namespace meshorder
