// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/motion_file.hpp"

#include <vector>

namespace meshorder {

/// How far apart the same vertices are in this order and in the study's first, at the times of the frames.
struct MotionDifference {
  std::vector<double> by_frame;  ///< largest distance, as a share of the body's longest side
  double largest = 0;

  bool operator==(const MotionDifference&) const = default;
};

/// How far the same vertices are apart in two motions of a body whose box's longest side is that long, frame
/// by frame. Throws InvalidArgument when they have other numbers of vertices or frames. O(vertices · frames).
MotionDifference difference_of(const Motion& motion, const Motion& reference, double longest_side);

}  // namespace meshorder
