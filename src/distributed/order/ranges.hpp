// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"
#include "distributed/order/local_orders.hpp"

#include <vector>

namespace meshorder::distributed {

/// Parts that are ranges of one order of the whole graph.
struct RangesOfOrder {
  PartOrders parts;
  double imbalance = 1;  ///< size of the largest part / mean size
  GlobalIndex cut = 0;   ///< number of edges between parts
};

/// Cuts an order into ranges whose sizes differ by at most one. Every rank has to call it. O(entries).
///
/// @param halo         of the graph's ghosts
/// @param new_numbers  of the vertices in the graph's rows
/// @param parts        ≥ 1
/// @throws as `Communicator::exchange`
[[nodiscard]] RangesOfOrder ranges_of(const Communicator& communicator, const GlobalGraph& graph,
                                      const Halo& halo, std::vector<GlobalIndex> new_numbers, Index parts);

}  // namespace meshorder::distributed
