// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"

#include <array>
#include <optional>

namespace meshorder {

/// The barycentric coordinates of x in a tetrahedron, if it is strictly inside: x is in the bounding box of
/// the corners, and with each face it spans a volume of more than a millionth of the whole and of rounding
/// errors (1e-12 of the cube of the longest side of that box). So neither what touches counts, nor what is in
/// a tetrahedron that is flat or whose corners do not turn like those of the unit tetrahedron (0, e₁, e₂,
/// e₃): inside out. Nothing is inside where a number is NaN.
std::optional<std::array<double, 4>> weights_inside(const Point& x, const std::array<Point, 4>& corners);

}  // namespace meshorder
