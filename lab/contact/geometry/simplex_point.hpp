// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace meshorder {

/// The point of a triangle that is nearest to a given point.
struct TrianglePoint {
  /// The part of the triangle on which the point lies: corner 0 … 2, the edge from corner 0, 1 or 2 to the
  /// next, or the interior.
  enum class On : std::uint8_t { corner0, corner1, corner2, edge0, edge1, edge2, face };

  Point at{};
  std::array<double, 3> weights{};  ///< of the corners, none negative, the sum 1
  On on = On::face;
  double squared_distance = 0.0;
};

/// Returns the point of the triangle abc nearest to x (Ericson, Real-Time Collision Detection, 2005, section
/// 5.1.5). Triangles may be degenerate.
TrianglePoint nearest_on_triangle(const Point& x, const Point& a, const Point& b, const Point& c);

/// Returns the barycentric coordinates of x in a tetrahedron, if x is strictly inside:
/// - x is in the bounding box of the corners;
/// - x and each face span a volume of more than a millionth of the tetrahedron's volume, plus a bound of
///   rounding errors: 1e-12 / 6 of the cube of the longest side of that box.
///
/// A point that touches the surface is not inside. A tetrahedron that is flat, or not oriented like the unit
/// tetrahedron (0, e₁, e₂, e₃), has no inside. If a number is NaN, x is not inside.
std::optional<std::array<double, 4>> weights_inside(const Point& x, const std::array<Point, 4>& corners);

}  // namespace meshorder
