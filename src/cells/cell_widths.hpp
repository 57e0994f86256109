// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/shape.hpp>

#include <set>

namespace meshorder {

/// Returns the usual numbers of vertices of a shape: complete cells up to order 10, cells whose vertices are
/// all on edges, and a few others that programs use. Empty for shapes that take any number of vertices, such
/// as lines. O(1).
std::set<int> cell_widths(Shape shape);

}  // namespace meshorder
