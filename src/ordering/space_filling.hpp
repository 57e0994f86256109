// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace meshorder {

/// Points on a lattice of 2^bits cells along each of their axes.
struct LatticePoints {
  int axes = 3;   ///< axes along which the points extend; the others are left out
  int bits = 21;  ///< axes · bits ≤ 63
  std::vector<std::array<std::uint32_t, 3>> coordinates;
};

/// Throws InvalidArgument, naming `method`, unless there are `count` points.
void check_points(const PointsView& points, std::size_t count, std::string_view method);

/// The points on the finest lattice of cubes that covers their bounding box and whose cell number fits in 64
/// bits. O(points).
LatticePoints on_lattice(const PointsView& points);

/// One bit of each axis in turn, highest first: the number of a cell along Morton's curve.
std::uint64_t interleaved(const std::array<std::uint32_t, 3>& coordinates, int axes, int bits);

}  // namespace meshorder
