// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder {

/// Returns the cells that name a vertex twice, ascending. O(vertex entries).
std::vector<Index> degenerate_cells(const Cells& cells);

/// Returns a note on `count` cells that name a vertex twice.
///
/// @param first  number of the first such cell
std::string note_of_degenerate(std::int64_t count, std::int64_t first);

/// Appends `count` cells of one shape with `nodes` vertices each, which are all vertex 0. O(count · nodes).
void append_cells(Cells& cells, Shape shape, int nodes, Index count);

/// Trims `count` cells from cell `first` on to their corners, which are their first vertices; removes all
/// cells after these. O(vertices of the trimmed cells).
void trim_to_corners(Cells& cells, Index first, Index count);

}  // namespace meshorder
