// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "kernels/simplices.hpp"

#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// The surface of a body of tetrahedra: the faces that belong to only one tetrahedron.
struct BodySurface {
  std::vector<std::array<Index, 3>>
      triangles;                ///< counterclockwise seen from outside, in the order of tetrahedra
  std::vector<Index> vertices;  ///< of these triangles, ascending
};

/// Returns the surface of all components of the body, cavities included. The faces of a tetrahedron that has
/// a negative volume at `points` are flipped. Throws InvalidArgument for simplices that are no tetrahedra or
/// corners that are not among the points. O(n log n).
BodySurface body_surface(const Simplices& simplices, std::span<const Point> points);

}  // namespace meshorder
