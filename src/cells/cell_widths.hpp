// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/shape.hpp>

#include <set>

namespace meshorder {

/// Returns the numbers of vertices that cells of a shape have: those of complete cells up to order 10, those
/// of cells whose vertices are all on edges, and a few others that programs use. Empty for shapes with any
/// number of vertices, which include lines. O(1).
std::set<int> cell_widths(Shape shape);

}  // namespace meshorder
