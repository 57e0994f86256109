// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/motion_difference.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

double distance(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return std::hypot(double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]}, double{a[2]} - double{b[2]});
}

}  // namespace

MotionDifference difference_of(const Motion& motion, const Motion& reference, double longest_side) {
  if (motion.vertices != reference.vertices || motion.frames.size() != reference.frames.size())
    throw InvalidArgument("motions of different bodies, or with different frames, cannot be compared");
  MotionDifference difference;
  for (std::size_t frame = 0; frame < motion.frames.size(); ++frame) {
    double largest = 0;
    for (std::size_t v = 0; v < motion.frames[frame].size(); ++v)
      largest = std::max(largest, distance(motion.frames[frame][v], reference.frames[frame][v]));
    difference.by_frame.push_back(largest / longest_side);
    difference.largest = std::max(difference.largest, difference.by_frame.back());
  }
  return difference;
}

}  // namespace meshorder
