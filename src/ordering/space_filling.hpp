// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace meshorder {

/// A box along the axes, at first without points. Adding another box extends this box to enclose both.
struct Box {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Point low{kInfinity, kInfinity, kInfinity};
  Point high{-kInfinity, -kInfinity, -kInfinity};

  Box& operator+=(const Box& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
    return *this;
  }
};

/// A lattice of cubes that covers a box, with 2^bits cells along the longest axis of the box: 2^21 if the box
/// extends along three axes, else 2^31. A cell number has at most 63 bits.
class Lattice {
 public:
  /// @param low   least coordinates of the box, finite
  /// @param high  largest coordinates; not below `low`
  Lattice(const Point& low, const Point& high);

  /// Returns the number of axes along which the box extends; other axes are left out.
  [[nodiscard]] int axes() const noexcept { return axes_; }
  /// Returns the bits of a coordinate; axes · bits ≤ 63.
  [[nodiscard]] int bits() const noexcept { return bits_; }
  /// Returns the cell that a point of the box is in. O(1).
  [[nodiscard]] std::array<std::uint32_t, 3> cell_of(const Point& point) const;

 private:
  int axes_ = 0;
  int bits_ = 31;
  std::array<int, 3> used_{};  ///< the axes along which the box extends
  Point low_;
  double shrink_ = 1;  ///< 0.5 if the box's extent exceeds the largest double, else 1
  double last_ = 0;    ///< largest coordinate of a cell, 2^bits − 1
  double extent_ = 0;  ///< length of the longest axis: one scale for all, so that cells are cubes
};

/// Throws InvalidArgument, naming `method`, unless there are `count` points.
void check_points(const PointsView& points, std::size_t count, std::string_view method);

/// Returns the `Lattice` of the points' bounding box; without points, a lattice without axes. O(points).
Lattice lattice_of(const PointsView& points);

/// Returns the number of a cell along Morton's curve: one bit of each axis in turn, highest first.
std::uint64_t interleaved(const std::array<std::uint32_t, 3>& coordinates, int axes);

/// Returns the number of the lattice cell x along Hilbert's curve, below 2^63. O(bits).
std::uint64_t hilbert_key(const std::array<std::uint32_t, 3>& x, int axes, int bits);

}  // namespace meshorder
