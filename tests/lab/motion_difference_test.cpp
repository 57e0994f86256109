// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/motion_difference.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

Motion two_frames() { return {2, {{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}, {1, 0, 1}}}}; }

TEST(MotionDifference, IsTheLargestDistanceOfAVertexFromItself) {
  Motion moved = two_frames();
  moved.frames[1][0] = {3, 4, 1};  // 5 away
  moved.frames[1][1] = {1, 2, 1};  // 2 away
  const MotionDifference difference = difference_of(moved, two_frames(), 10);
  EXPECT_EQ(difference.by_frame, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(difference.largest, 0.5);
}

TEST(MotionDifference, RefusesAnotherBodyAndOtherFrames) {
  Motion other = two_frames();
  other.frames.pop_back();
  EXPECT_THROW(difference_of(other, two_frames(), 1), InvalidArgument);
  EXPECT_THROW(difference_of({1, {{{0, 0, 0}}, {{0, 0, 0}}}}, two_frames(), 1), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
