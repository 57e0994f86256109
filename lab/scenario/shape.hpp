// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"

#include <span>

namespace meshorder {

/// How far a body is from a rigid motion of its rest shape: the largest distance, over `vertices`, of a
/// vertex from where the rotation and translation that fit best in the mean square (Kabsch 1976) take it.
/// Lengths as those of the points. 0 for no vertices. O(vertices).
double distance_from_shape(std::span<const Point> rest, std::span<const Point> positions,
                           std::span<const Index> vertices);

}  // namespace meshorder
