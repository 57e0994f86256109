// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/sim/contact/body_surface.hpp>
#include <meshorder/sim/contact/box_tree.hpp>

#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// A body's surface in its rest shape, in which the way out of the body is looked up.
class RestSurface {
 public:
  static constexpr Index kNone = -1;

  struct Place {
    Index triangle = kNone;
    std::array<double, 3> weights{};  ///< of the triangle's corners
    double distance = 0.0;            ///< m, not signed
  };

  RestSurface(std::vector<std::array<Index, 3>> triangles, std::span<const Point> points);

  /// The point of the surface nearest to x, among triangles without the corner `left_out`. Of triangles that
  /// are equally near (to 1e-9), which meet there, it is the one that faces x most, and then the first; so
  /// the numbering of triangles decides only between mirror images. The triangle is kNone where there is
  /// none.
  [[nodiscard]] Place nearest(const Point& x, Index left_out = kNone) const;

  [[nodiscard]] const std::array<Index, 3>& triangle(Index t) const { return triangles_[t]; }
  /// Memory held.
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::vector<std::array<Index, 3>> triangles_;
  std::vector<Point> points_;
  BoxTree tree_;
};

}  // namespace meshorder
