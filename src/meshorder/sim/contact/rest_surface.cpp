// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/contact/rest_surface.hpp>
#include <meshorder/sim/contact/triangle_point.hpp>
#include <meshorder/sim/contact/vectors.hpp>

#include <algorithm>
#include <limits>

namespace meshorder {
namespace {

std::vector<Box> boxes_of(std::span<const std::array<Index, 3>> triangles, std::span<const Point> points) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const Index v : triangles[t]) boxes[t].include(points[v]);
  }
  return boxes;
}

}  // namespace

RestSurface::RestSurface(std::vector<std::array<Index, 3>> triangles, std::span<const Point> points)
    : triangles_(std::move(triangles)),
      points_(points.begin(), points.end()),
      tree_(boxes_of(triangles_, points_)) {}

RestSurface::Place RestSurface::nearest(const Point& x, Index left_out) const {
  constexpr double kEqual = 1.0 + 1e-9;
  struct Candidate {
    Index triangle = kNone;
    TrianglePoint point;
  };
  std::vector<Candidate> candidates;
  double least = std::numeric_limits<double>::infinity();
  tree_.visit_nearest(x, [&](Index t) {
    const std::array<Index, 3>& corners = triangles_[t];
    if (std::find(corners.begin(), corners.end(), left_out) == corners.end()) {
      const TrianglePoint point =
          nearest_on_triangle(x, points_[corners[0]], points_[corners[1]], points_[corners[2]]);
      if (point.squared_distance <= kEqual * least) candidates.push_back({t, point});
      least = std::min(least, point.squared_distance);
    }
    return kEqual * least;
  });

  Place best;
  double best_facing = -1.0;
  for (const Candidate& candidate : candidates) {
    if (!(candidate.point.squared_distance <= kEqual * least)) continue;
    const std::array<Index, 3>& corners = triangles_[candidate.triangle];
    const Point& a = points_[corners[0]];
    const Point normal = cross(minus(points_[corners[1]], a), minus(points_[corners[2]], a));
    const double length = norm(normal);
    const double facing = length > 0.0 ? std::abs(dot(minus(x, a), normal)) / length : 0.0;
    if (facing < best_facing || (facing == best_facing && candidate.triangle > best.triangle)) continue;
    best_facing = facing;
    best = {candidate.triangle, candidate.point.weights, std::sqrt(candidate.point.squared_distance)};
  }
  return best;
}

std::size_t RestSurface::bytes() const {
  return triangles_.capacity() * sizeof(triangles_[0]) + points_.capacity() * sizeof(Point) + tree_.bytes();
}

}  // namespace meshorder
