// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"

#include <array>
#include <optional>

namespace meshorder {

/// Returns the barycentric coordinates of x in a tetrahedron, if x is strictly inside: in the bounding box of
/// the corners, and spanning with each face a volume of more than a millionth of the whole plus a bound of
/// rounding errors (1e-12 / 6 of the cube of the longest side of that box). So a point that touches the
/// surface is not inside, nor is anything inside a tetrahedron that is flat or oriented unlike the unit
/// tetrahedron (0, e₁, e₂, e₃). Nothing is inside where a number is NaN.
std::optional<std::array<double, 4>> weights_inside(const Point& x, const std::array<Point, 4>& corners);

}  // namespace meshorder
