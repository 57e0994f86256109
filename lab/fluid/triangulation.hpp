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

/// Triangulates points. None of them may be NaN or infinite. A point that coincides with another has no
/// tetrahedron, and points of one plane have none at all. The triangulation of points that
/// differ does not depend on their numbers.
using Triangulate = std::function<Triangulation(std::span<const Point>)>;

/// Returns whether there is the program `meshorder-delaunay`.
bool has_delaunay_program();

/// Returns a function that triangulates by the program `meshorder-delaunay`, which is started once. Its calls
/// throw Error if the program ended. Throws Error if there is no such program. Looks for it beside this
/// program and on PATH, never where a scenario says, and trusts it like this program. Checks its answers.
Triangulate delaunay_program();

}  // namespace meshorder
