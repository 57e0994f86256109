// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/view.hpp>

#include <cmath>

namespace meshorder {

/// Returns point `i` of a view, with 0 along axes that the view does not have.
inline Point point_at(const PointsView& points, Index i) {
  const auto at = static_cast<std::size_t>(i);
  return {points(at, 0), points(at, 1), points(at, 2)};
}

inline Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Point scaled(double factor, const Point& a) { return {factor * a[0], factor * a[1], factor * a[2]}; }
/// Returns a + factor · b.
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

}  // namespace meshorder
