// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/order/mesh_slice.hpp"

#include <vector>

namespace meshorder::distributed {

/// Returns the new place of each cell of a slice. The cells of a dimension keep the places of that dimension,
/// in the sequence of `in_order`, this rank's range of all cells. Every rank has to call it. O(cells).
///
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<GlobalIndex> places_by_dimension(const Communicator& communicator,
                                                           const MeshSlice& slice,
                                                           const std::vector<GlobalIndex>& in_order);

/// Returns the new place of each cell of this rank if cells stay in their blocks: the cells of a block keep
/// its places, in the sequence of `in_order`. Every rank has to call it. O(cells · log blocks),
/// O(blocks · ranks) at the root.
///
/// @param cells       the owners of the cells
/// @param block_ends  0 and the end of each block, the same on all ranks
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<GlobalIndex> places_by_block(const Communicator& communicator, const Layout& cells,
                                                       const std::vector<GlobalIndex>& block_ends,
                                                       const std::vector<GlobalIndex>& in_order);

}  // namespace meshorder::distributed
