// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder {

/// Returns the cells that name a vertex twice, ascending. O(vertex entries).
std::vector<Index> degenerate_cells(const Cells& cells);

}  // namespace meshorder
