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

/// A box along the axes, at first one of no points. Adding another encloses it, too.
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

/// The finest lattice of cubes that covers a box and whose cell number fits in 64 bits: 2^bits cells along
/// each axis.
class Lattice {
 public:
  /// @param low   least coordinates of the box, finite
  /// @param high  largest ones; not below `low`
  Lattice(const Point& low, const Point& high);

  /// Returns how many axes the box extends along; the others are left out.
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
  double shrink_ = 1;  ///< a box whose extent no double holds is halved
  double last_ = 0;    ///< cell along an axis
  double extent_ = 0;  ///< of the longest axis: one scale for all, so that cells are cubes
};

/// Throws InvalidArgument, naming `method`, unless there are `count` points.
void check_points(const PointsView& points, std::size_t count, std::string_view method);

/// The `Lattice` of the points' bounding box; without points of no axes. O(points).
Lattice lattice_of(const PointsView& points);

/// One bit of each axis in turn, highest first: the number of a cell along Morton's curve.
std::uint64_t interleaved(const std::array<std::uint32_t, 3>& coordinates, int axes);

/// The number of the lattice cell x along Hilbert's curve, below 2^63. O(bits).
std::uint64_t hilbert_key(const std::array<std::uint32_t, 3>& x, int axes, int bits);

}  // namespace meshorder
