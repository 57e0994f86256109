// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "lab/scenario/motion_file.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// How far a body is from a rigid motion of its rest shape: the largest distance, over `vertices`, of a
/// vertex from where the rotation and translation that fit best in the mean square (Kabsch 1976) take it.
/// Lengths as those of the points. 0 for no vertices. O(vertices).
double distance_from_shape(std::span<const Point> rest, std::span<const Point> positions,
                           std::span<const Index> vertices);

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
