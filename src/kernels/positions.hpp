// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "kernels/aligned.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

namespace meshorder {

/// Numbers per vertex in the positions and forces of the element and spring kernels: x, y, z and a fourth
/// number that stays 0, so that a vertex never straddles a cache line and aligned vector loads can read it.
inline constexpr Index kPaddedStride = 4;

/// Returns n vertices at zero with kPaddedStride numbers each. O(n).
inline AlignedVector<double> padded_zeros(Index n) {
  return AlignedVector<double>(Offset{kPaddedStride} * n, 0.0);
}

/// Returns the points with kPaddedStride numbers each. O(n).
inline AlignedVector<double> padded_positions(std::span<const Point> points) {
  AlignedVector<double> result = padded_zeros(index_size(points));
  auto place = result.begin();
  for (const Point& point : points) {
    std::copy(point.begin(), point.end(), place);
    place += kPaddedStride;
  }
  return result;
}

/// Throws InvalidArgument, naming `function`, unless positions and forces have the same size.
inline void check_same_size(std::span<const double> positions, std::span<const double> forces,
                            const char* function) {
  if (positions.size() != forces.size()) {
    throw InvalidArgument(std::string(function) + ": positions and forces must have the same size");
  }
}

/// Returns vertex v of padded positions.
inline Point point_of(std::span<const double> positions, Index v) {
  const double* const x = positions.data() + Offset{kPaddedStride} * v;
  return {x[0], x[1], x[2]};
}

/// Returns the unit normal of a triangle at these positions; nothing if the triangle has no area or the
/// normal is not finite.
inline std::optional<Point> triangle_normal(std::span<const double> positions, Index a, Index b, Index c) {
  const Point origin = point_of(positions, a);
  const Point normal = cross(minus(point_of(positions, b), origin), minus(point_of(positions, c), origin));
  const double length = norm(normal);
  if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  return scaled(1.0 / length, normal);
}

}  // namespace meshorder
