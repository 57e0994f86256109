// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/embedded_vertices.hpp"

#include "base/point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshorder {
namespace {

double determinant(const Point& a, const Point& b, const Point& c) { return dot(a, cross(b, c)); }

/// Returns barycentric coordinates of `at` by Cramer's rule; not finite in a flat tetrahedron.
std::array<double, 4> weights_of(const Point& at, const std::array<Point, 4>& corners) {
  const Point a = minus(corners[1], corners[0]);
  const Point b = minus(corners[2], corners[0]);
  const Point c = minus(corners[3], corners[0]);
  const Point x = minus(at, corners[0]);
  const double volume = determinant(a, b, c);
  const std::array<double, 3> shares{determinant(x, b, c) / volume, determinant(a, x, c) / volume,
                                     determinant(a, b, x) / volume};
  return {1.0 - shares[0] - shares[1] - shares[2], shares[0], shares[1], shares[2]};
}

}  // namespace

std::vector<EmbeddedVertex> embed_vertices(const Mesh& mesh, const Simplices& simplices) {
  std::vector<char> is_corner(mesh.points.size(), 0);
  for (const Index v : simplices.vertices) is_corner[v] = 1;
  std::vector<EmbeddedVertex> found(mesh.points.size());
  std::vector<double> depth(mesh.points.size(), -std::numeric_limits<double>::infinity());
  for (Offset s = 0; s < simplices.size(); ++s) {
    std::array<Index, 4> corners{};
    std::copy_n(simplices.vertices.begin() + 4 * s, 4, corners.begin());
    std::array<Point, 4> points{};
    for (std::size_t i = 0; i < 4; ++i) points[i] = mesh.points[corners[i]];
    for (const Index v : mesh.cells[simplices.cells[s]]) {
      if (is_corner[v] != 0) continue;
      const std::array<double, 4> weights = weights_of(mesh.points[v], points);
      const double least = *std::min_element(weights.begin(), weights.end());
      if (!(least > depth[v])) continue;
      depth[v] = least;
      found[v] = {v, corners, weights};
    }
  }
  std::vector<EmbeddedVertex> result;
  for (std::size_t v = 0; v < found.size(); ++v) {
    if (std::isfinite(depth[v])) result.push_back(found[v]);
  }
  return result;
}

void move_embedded(const std::vector<EmbeddedVertex>& embedded, std::span<const Point> rest,
                   MotionState& state) {
  for (const EmbeddedVertex& entry : embedded) {
    Point& position = state.positions[entry.vertex];
    position = rest[entry.vertex];
    Point& velocity = state.velocities[entry.vertex];
    velocity = {};
    for (std::size_t i = 0; i < 4; ++i) {
      const Index corner = entry.corners[i];
      for (std::size_t c = 0; c < 3; ++c) {
        position[c] += entry.weights[i] * (state.positions[corner][c] - rest[corner][c]);
        velocity[c] += entry.weights[i] * state.velocities[corner][c];
      }
    }
  }
}

}  // namespace meshorder
