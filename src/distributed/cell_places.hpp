// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/communicator.hpp"
#include "distributed/layout.hpp"
#include "distributed/mesh_slice.hpp"

#include <vector>

namespace meshorder::distributed {

/// Returns the new place of each cell of a slice: those of a dimension take their places in the order in
/// which `in_order`, this rank's share of all cells, lists them. Every rank has to call it. O(cells).
///
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<GlobalIndex> places_by_dimension(const Communicator& communicator,
                                                           const MeshSlice& slice,
                                                           const std::vector<GlobalIndex>& in_order);

}  // namespace meshorder::distributed
