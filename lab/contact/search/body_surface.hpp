// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "kernels/simplices.hpp"

#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// The surface of a body of tetrahedra: the faces that one of them alone has.
struct BodySurface {
  std::vector<std::array<Index, 3>>
      triangles;                ///< counterclockwise seen from outside, in the order of tetrahedra
  std::vector<Index> vertices;  ///< of these triangles, ascending
};

/// The surface of all of the body's components, of their cavities too. Where a tetrahedron's corners turn the
/// other way at `points`, its faces are turned. Throws InvalidArgument for simplices that are no tetrahedra
/// and corners that are not among the points. O(n log n).
BodySurface body_surface(const Simplices& simplices, std::span<const Point> points);

}  // namespace meshorder
