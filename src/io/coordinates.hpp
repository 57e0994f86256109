// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <algorithm>
#include <vector>

namespace meshorder {

/// Returns whether `float` can hold all coordinates exactly. O(points).
inline bool are_float_points(const std::vector<Point>& points) {
  return std::all_of(points.begin(), points.end(), [](const Point& point) {
    return std::all_of(point.begin(), point.end(),
                       [](double x) { return double{static_cast<float>(x)} == x; });
  });
}

/// Returns the number of coordinates that points need, at least `of_file`. O(points).
inline int coordinates_of(const std::vector<Point>& points, int of_file) {
  int needed = of_file;
  for (const Point& point : points) {
    if (point[2] != 0) return 3;
    if (point[1] != 0) needed = std::max(needed, 2);
  }
  return needed;
}

}  // namespace meshorder
