// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/geometry/box_tree.hpp"
#include "lab/contact/search/body_surface.hpp"

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace meshorder {

/// A body's surface in its rest shape, for finding the shortest way out of the body.
class RestSurface {
 public:
  static constexpr Index kNone = -1;

  struct Place {
    Index triangle = kNone;
    std::array<double, 3> weights{};  ///< of the triangle's corners
    double distance = 0.0;            ///< m, not signed
  };

  RestSurface(std::vector<std::array<Index, 3>> triangles, std::span<const Point> points);

  /// Returns the point of the surface nearest to x, among triangles without the corner `left_out`. Of several
  /// triangles that are equally near (to 1e-9), takes the one that faces x most; the numbering of triangles
  /// decides only between mirror images. The result's triangle is kNone if no triangle was found. `within` is
  /// an upper bound of the distance, m; a small bound saves time.
  [[nodiscard]] Place nearest(const Point& x, Index left_out = kNone,
                              double within = std::numeric_limits<double>::infinity()) const;

  [[nodiscard]] const std::array<Index, 3>& triangle(Index t) const { return triangles_[t]; }
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Triangle {
    std::array<Point, 3> points{};
    std::array<Index, 3> corners{};
    Index number = 0;
  };

  std::vector<std::array<Index, 3>> triangles_;
  BoxTree tree_;
  std::vector<Triangle> in_tree_;  ///< in the order of the tree
};

}  // namespace meshorder
