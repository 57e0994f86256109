// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/base/index.hpp>
#include <meshorder/base/point.hpp>
#include <meshorder/sim/kernels/positions.hpp>

#include <cmath>
#include <optional>
#include <span>

namespace meshorder {

inline Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Point scaled(double factor, const Point& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }
/// a + factor · b
inline Point plus_scaled(const Point& a, double factor, const Point& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Point& a) { return std::sqrt(dot(a, a)); }
inline bool is_finite(const Point& a) {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

/// Vertex v of padded positions.
inline Point point_of(std::span<const double> positions, Index v) {
  const double* const x = positions.data() + Offset{kPaddedStride} * v;
  return {x[0], x[1], x[2]};
}

/// The direction that a triangle of moved vertices faces, of length 1; none where it has no area.
inline std::optional<Point> triangle_normal(std::span<const double> positions, Index a, Index b, Index c) {
  const Point origin = point_of(positions, a);
  const Point normal = cross(minus(point_of(positions, b), origin), minus(point_of(positions, c), origin));
  const double length = norm(normal);
  if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  return scaled(1.0 / length, normal);
}

}  // namespace meshorder
