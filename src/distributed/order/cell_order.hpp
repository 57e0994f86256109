// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <vector>

namespace meshorder::distributed {

/// Orders cells by the new numbers of their vertices, largest first, compared like words, ties by the cells'
/// numbers: the serial order `lexmax` of all of them. Every rank has to call it. O(entries + m log m) for m
/// cells of a rank.
///
/// @param cells          who has which cells
/// @param cell_vertices  new numbers of the vertices of the own ones, each with one at least; taken
/// @param vertices       of the new numbers: the rank of a cell's largest one orders it
/// @return this rank's share of the cells' numbers in their new order, which goes on on the next rank
/// @throws as `Communicator::exchange`; SharedError where a rank gets more than 2,147,483,647 cells
[[nodiscard]] std::vector<GlobalIndex> cells_by_lexmax(const Communicator& communicator, const Layout& cells,
                                                       Rows cell_vertices, const Layout& vertices);

/// The same for the cells of this rank alone. Returns their places, from 0 on, in their new order.
///
/// @throws TooLarge for more than 2,147,483,647 cells
[[nodiscard]] std::vector<GlobalIndex> own_cells_by_lexmax(const Rows& cell_vertices);

}  // namespace meshorder::distributed
