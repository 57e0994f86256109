// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace meshorder {

/// The tetrahedra of a Delaunay triangulation, positively oriented.
struct Triangulation {
  std::vector<std::array<Index, 4>> corners;
  /// The tetrahedron across the face that lies opposite each corner; −1 outside the hull.
  std::vector<std::array<Index, 4>> neighbours;
};

/// A function that triangulates points, which must be finite. Of points that coincide, only one has
/// tetrahedra; points that all lie in one plane have none. If all points differ, the triangulation does not
/// depend on their numbers.
using Triangulate = std::function<Triangulation(std::span<const Point>)>;

/// Returns whether the program `meshorder-delaunay` is found.
bool has_delaunay_program();

/// Starts the program `meshorder-delaunay` and returns a function that triangulates with the program. The
/// function checks the program's answers, and throws Error for a bad answer or if the program has ended.
/// Throws Error if the program is not found beside this program or on PATH. The program is trusted like this
/// program; a scenario cannot name another program.
Triangulate delaunay_program();

}  // namespace meshorder
