// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"
#include "distributed/order/mesh_slice.hpp"

#include <vector>

namespace meshorder::distributed {

/// Orders cells lexicographically by the new numbers of their vertices, the largest first; ties by the cells'
/// numbers. This is the serial order `lexmax` of all cells. Every rank has to call it. O(entries + m log m)
/// for m cells of a rank.
///
/// @param cells          the owners of the cells
/// @param cell_vertices  new numbers of each cell's vertices, at least one; freed before the exchange
/// @param vertices       layout of the new numbers: the owner of a cell's largest number sorts the cell
/// @return the old numbers of the cells in this rank's range of the new order; ranges are in rank order
/// @throws as `Communicator::exchange`; SharedError if a rank gets more than 2,147,483,647 cells or vertices
[[nodiscard]] std::vector<GlobalIndex> cells_by_lexmax(const Communicator& communicator, const Layout& cells,
                                                       Rows cell_vertices, const Layout& vertices);

/// Returns the indices, from 0 on, of this rank's cells, sorted by `lexmax` among these cells alone.
///
/// @throws TooLarge for more than 2,147,483,647 cells or vertices
[[nodiscard]] std::vector<GlobalIndex> own_cells_by_lexmax(const Rows& cell_vertices);

/// Returns the new place of each cell of a slice. Each cell gets the place of a cell of its dimension. Cells
/// of one dimension follow `in_order`, this rank's range of all cells in their new order. Every rank has to
/// call it. O(cells).
///
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<GlobalIndex> places_by_dimension(const Communicator& communicator,
                                                           const MeshSlice& slice,
                                                           const std::vector<GlobalIndex>& in_order);

/// Returns the new place of each cell of this rank if cells stay in their blocks: the cells of a block fill
/// the places of the block in the sequence of `in_order`. Every rank has to call it. O(cells · log blocks),
/// O(blocks · ranks) at the root.
///
/// @param cells       the owners of the cells
/// @param block_ends  0, then the end of each block; the same on all ranks
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<GlobalIndex> places_by_block(const Communicator& communicator, const Layout& cells,
                                                       const std::vector<GlobalIndex>& block_ends,
                                                       const std::vector<GlobalIndex>& in_order);

}  // namespace meshorder::distributed
