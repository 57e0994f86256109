// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

namespace meshorder {

/// Appends `count` cells of one shape with `nodes` vertices each, all of them vertex 0. O(cells · nodes).
void append_cells(Cells& cells, Shape shape, int nodes, Index count);

}  // namespace meshorder
