// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace meshorder {

/// The point of a triangle nearest to another point.
struct TrianglePoint {
  /// Feature of the triangle it lies on: corner 0 … 2, the edge from corner 0, 1 or 2 to the next, or the
  /// interior.
  enum class On : std::uint8_t { corner0, corner1, corner2, edge0, edge1, edge2, face };

  Point at{};
  std::array<double, 3> weights{};  ///< of the corners, none negative, the sum 1
  On on = On::face;
  double squared_distance = 0.0;
};

/// Returns the point of the triangle abc nearest to x (Ericson, Real-Time Collision Detection, 2005, section
/// 5.1.5). Triangles may be degenerate.
TrianglePoint nearest_on_triangle(const Point& x, const Point& a, const Point& b, const Point& c);

/// Returns the barycentric coordinates of x in a tetrahedron, if x is strictly inside: in the bounding box of
/// the corners, and spanning with each face a volume of more than a millionth of the whole plus a bound of
/// rounding errors (1e-12 / 6 of the cube of the longest side of that box). So a point that touches the
/// surface is not inside, nor is anything inside a tetrahedron that is flat or oriented unlike the unit
/// tetrahedron (0, e₁, e₂, e₃). Nothing is inside where a number is NaN.
std::optional<std::array<double, 4>> weights_inside(const Point& x, const std::array<Point, 4>& corners);

}  // namespace meshorder
