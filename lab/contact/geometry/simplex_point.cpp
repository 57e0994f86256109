// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/geometry/simplex_point.hpp"

#include "lab/contact/geometry/box_tree.hpp"

#include <algorithm>

namespace meshorder {
namespace {

using On = TrianglePoint::On;

/// Returns the point nearest to x on the edge from corner k to the next corner.
TrianglePoint nearest_on_edge(const Point& x, const std::array<Point, 3>& corners, int k) {
  const int next = (k + 1) % 3;
  const Point edge = minus(corners[next], corners[k]);
  const double along = dot(minus(x, corners[k]), edge);
  const double square = dot(edge, edge);
  TrianglePoint result;
  if (!(along > 0.0)) {
    result.on = static_cast<On>(k);
    result.weights[k] = 1.0;
    result.at = corners[k];
  } else if (along >= square) {
    result.on = static_cast<On>(next);
    result.weights[next] = 1.0;
    result.at = corners[next];
  } else {
    const double part = along / square;
    result.on = static_cast<On>(3 + k);
    result.weights[k] = 1.0 - part;
    result.weights[next] = part;
    result.at = plus_scaled(corners[k], part, edge);
  }
  const Point way = minus(x, result.at);
  result.squared_distance = dot(way, way);
  return result;
}

}  // namespace

TrianglePoint nearest_on_triangle(const Point& x, const Point& a, const Point& b, const Point& c) {
  const std::array<Point, 3> corners{a, b, c};
  const Point normal = cross(minus(b, a), minus(c, a));
  const double square = dot(normal, normal);
  // entry k is negative if x is on the outer side of edge k
  std::array<double, 3> inside{};
  for (int k = 0; k < 3; ++k) {
    const Point& p = corners[k];
    inside[k] = dot(cross(minus(corners[(k + 1) % 3], p), minus(x, p)), normal);
  }
  if (square > 0.0 && inside[0] >= 0.0 && inside[1] >= 0.0 && inside[2] >= 0.0) {
    TrianglePoint result;
    const double sum = inside[0] + inside[1] + inside[2];
    result.weights = {inside[1] / sum, inside[2] / sum, inside[0] / sum};
    const double height = dot(minus(x, a), normal) / square;
    result.at = plus_scaled(x, -height, normal);
    result.squared_distance = height * height * square;
    return result;
  }
  TrianglePoint best;
  bool any = false;
  for (int k = 0; k < 3; ++k) {
    if (square > 0.0 && inside[k] >= 0.0) continue;
    const TrianglePoint on_edge = nearest_on_edge(x, corners, k);
    if (any && !(on_edge.squared_distance < best.squared_distance)) continue;
    best = on_edge;
    any = true;
  }
  return best;
}

std::optional<std::array<double, 4>> weights_inside(const Point& x, const std::array<Point, 4>& corners) {
  constexpr double kPart = 1e-6;
  constexpr double kRounding = 1e-12;
  Box box;
  std::array<Point, 4> to{};
  for (int k = 0; k < 4; ++k) {
    box.include(corners[k]);
    to[k] = minus(corners[k], x);
  }
  if (!box.contains(x)) return std::nullopt;
  const Point sides = minus(box.upper, box.lower);
  const double longest = std::max({sides[0], sides[1], sides[2]});
  // six times the volumes that x spans with the faces opposite to the corners
  std::array<double, 4> volumes{dot(to[1], cross(to[2], to[3])), dot(to[0], cross(to[3], to[2])),
                                dot(to[0], cross(to[1], to[3])), dot(to[0], cross(to[2], to[1]))};
  const double all = volumes[0] + volumes[1] + volumes[2] + volumes[3];
  const double min_volume = kPart * all + kRounding * longest * longest * longest;
  bool inside = true;
  for (double& volume : volumes) {
    inside = inside && volume > min_volume;
    volume /= all;
  }
  if (!inside) return std::nullopt;
  return volumes;
}

}  // namespace meshorder
