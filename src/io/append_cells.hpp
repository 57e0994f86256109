// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

namespace meshorder {

/// Appends cells of one shape whose vertices, 0 now, are still to be read. O(cells · nodes).
void append_cells(Cells& cells, Shape shape, int nodes, Index count);

}  // namespace meshorder
