// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "base/random.hpp"
#include "lab/contact/search/body_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace meshorder::test {

/// Points and triangles, counterclockwise seen from outside.
struct Surface {
  std::vector<Point> points;
  std::vector<std::array<int, 3>> triangles;
};

/// The surface of a mesh of tetrahedra; all points of the mesh stay.
inline Surface surface_of(const Mesh& mesh) {
  return {mesh.points, body_surface(cut_into_simplices(mesh), mesh.points).triangles};
}

/// The unit cube.
inline Surface cube() {
  Surface result;
  for (int i = 0; i < 8; ++i)
    result.points.push_back(
        {static_cast<double>(i & 1), static_cast<double>(i >> 1 & 1), static_cast<double>(i >> 2)});
  for (const auto& q :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    result.triangles.push_back({q[0], q[1], q[2]});
    result.triangles.push_back({q[0], q[2], q[3]});
  }
  return result;
}

inline Point random_point(Random& random, double size) {
  return {size * (2 * random.unit() - 1), size * (2 * random.unit() - 1), size * (2 * random.unit() - 1)};
}

inline Point random_direction(Random& random) {
  Point p{};
  do p = random_point(random, 1.0);
  while (norm(p) > 1.0 || norm(p) < 0.1);
  return scaled(1.0 / norm(p), p);
}

/// The winding number of the surface around x, by solid angles (van Oosterom, Strackee 1983): 1 inside, 0
/// outside.
inline double winding_number(const Surface& surface, const Point& x) {
  double sum = 0.0;
  for (const auto& t : surface.triangles) {
    std::array<Point, 3> p{};
    std::array<double, 3> length{};
    for (int k = 0; k < 3; ++k) {
      p[k] = minus(surface.points[t[k]], x);
      length[k] = norm(p[k]);
    }
    sum += std::atan2(dot(p[0], cross(p[1], p[2])),
                      length[0] * length[1] * length[2] + dot(p[0], p[1]) * length[2] +
                          dot(p[1], p[2]) * length[0] + dot(p[2], p[0]) * length[1]);
  }
  return sum / (2 * std::numbers::pi);
}

/// The distance from x to a triangle: to its plane if the foot is inside, else to the nearest edge.
inline double distance_to_triangle(const Point& x, const Point& a, const Point& b, const Point& c) {
  double smallest = 1e300;
  for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}}) {
    const Point way = minus(q, p);
    const double square = dot(way, way);
    const double part = square > 0.0 ? std::clamp(dot(minus(x, p), way) / square, 0.0, 1.0) : 0.0;
    smallest = std::min(smallest, norm(minus(x, plus_scaled(p, part, way))));
  }
  const Point normal = cross(minus(b, a), minus(c, a));
  const double area = norm(normal);
  if (area == 0.0) return smallest;
  const double height = dot(minus(x, a), normal) / area;
  const Point foot = plus_scaled(x, -height / area, normal);
  bool inside = true;
  for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}})
    inside = inside && dot(cross(minus(q, p), minus(foot, p)), normal) >= 0.0;
  return inside ? std::abs(height) : smallest;
}

inline double distance_to_surface(const Surface& surface, const Point& x) {
  double smallest = 1e300;
  for (const auto& t : surface.triangles) {
    smallest = std::min(
        smallest, distance_to_triangle(x, surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]));
  }
  return smallest;
}

}  // namespace meshorder::test
