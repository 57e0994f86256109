// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <vector>

namespace meshorder::distributed {

/// Orders cells lexicographically by the new numbers of their vertices, sorted from the largest down; ties by
/// the cells' numbers. This is the serial order `lexmax` of all cells. Every rank has to call it.
/// O(entries + m log m) for m cells of a rank.
///
/// @param cells          the owners of the cells
/// @param cell_vertices  new numbers of the vertices of each own cell, at least one; freed early
/// @param vertices       layout of the new numbers: the owner of a cell's largest one sorts it
/// @return this rank's range of the cells' numbers in their new order; ranges follow in rank order
/// @throws as `Communicator::exchange`; SharedError if a rank gets more than 2,147,483,647 cells
[[nodiscard]] std::vector<GlobalIndex> cells_by_lexmax(const Communicator& communicator, const Layout& cells,
                                                       Rows cell_vertices, const Layout& vertices);

/// Returns the places, from 0 on, of this rank's cells in the order `lexmax` of these cells alone.
///
/// @throws TooLarge for more than 2,147,483,647 cells
[[nodiscard]] std::vector<GlobalIndex> own_cells_by_lexmax(const Rows& cell_vertices);

}  // namespace meshorder::distributed
