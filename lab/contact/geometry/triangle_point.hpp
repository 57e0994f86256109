// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"

#include <array>
#include <cstdint>

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

}  // namespace meshorder
