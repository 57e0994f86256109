// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/rest_surface.hpp"

#include "base/point.hpp"
#include "lab/contact/geometry/simplex_point.hpp"

#include <algorithm>

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
    : triangles_(std::move(triangles)), tree_(boxes_of(triangles_, points)) {
  for (const Index t : tree_.renumber()) {
    const std::array<Index, 3>& corners = triangles_[t];
    in_tree_.push_back({{points[corners[0]], points[corners[1]], points[corners[2]]}, corners, t});
  }
}

RestSurface::Place RestSurface::nearest(const Point& x, Index left_out, double within) const {
  constexpr double kEqual = 1.0 + 1e-9;
  struct Candidate {
    const Triangle* triangle = nullptr;
    TrianglePoint point;
  };
  std::vector<Candidate> candidates;
  double smallest = std::numeric_limits<double>::infinity();
  tree_.visit_nearest(
      x,
      [&](Index t) {
        const Triangle& triangle = in_tree_[t];
        if (std::find(triangle.corners.begin(), triangle.corners.end(), left_out) == triangle.corners.end()) {
          const auto& [a, b, c] = triangle.points;
          const TrianglePoint point = nearest_on_triangle(x, a, b, c);
          if (point.squared_distance <= kEqual * smallest) candidates.push_back({&triangle, point});
          smallest = std::min(smallest, point.squared_distance);
        }
        return kEqual * std::min(smallest, within * within);
      },
      kEqual * within * within);

  Place best;
  double best_facing = -1.0;
  for (const Candidate& candidate : candidates) {
    if (!(candidate.point.squared_distance <= kEqual * smallest)) continue;
    const auto& [a, b, c] = candidate.triangle->points;
    const Index number = candidate.triangle->number;
    const Point normal = cross(minus(b, a), minus(c, a));
    const double length = norm(normal);
    const double facing = length > 0.0 ? std::abs(dot(minus(x, a), normal)) / length : 0.0;
    if (facing < best_facing || (facing == best_facing && number > best.triangle)) continue;
    best_facing = facing;
    best = {number, candidate.point.weights, std::sqrt(candidate.point.squared_distance)};
  }
  return best;
}

std::size_t RestSurface::bytes() const {
  return triangles_.capacity() * sizeof(triangles_[0]) + in_tree_.capacity() * sizeof(Triangle) +
         tree_.bytes();
}

}  // namespace meshorder
