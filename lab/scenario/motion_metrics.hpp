// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "lab/scenario/motion_file.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Returns how far a body is from its rest shape: the largest distance, over `vertices`, between a vertex and
/// its rest position moved by the best rotation and translation (least squares; Kabsch 1976, A solution for
/// the best rotation to relate two sets of vectors). In the unit of the points; 0 without vertices.
/// O(vertices).
double distance_from_shape(std::span<const Point> rest, std::span<const Point> positions,
                           std::span<const Index> vertices);

/// Distance between the same vertices in two motions, frame by frame.
struct MotionDifference {
  std::vector<double> by_frame;  ///< largest distance divided by the body's longest side
  double largest = 0;

  bool operator==(const MotionDifference&) const = default;
};

/// Compares two motions of a body whose bounding box has that longest side. Throws InvalidArgument if they
/// differ in the number of vertices or frames. O(vertices · frames).
MotionDifference difference_of(const Motion& motion, const Motion& reference, double longest_side);

}  // namespace meshorder
