// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"

namespace meshorder::distributed {

/// As `EdgeSpan`, for 64-bit numbers.
struct GlobalEdgeSpan {
  double mean = 0;
  GlobalIndex max = 0;
  double mean_log2 = 0;
};

/// Returns the spans of a graph's edges in an order. Every rank has to call it. O(entries).
///
/// @param place_of  place of each vertex in the order
/// @throws as `Communicator::exchange`
[[nodiscard]] GlobalEdgeSpan edge_span(const Communicator& communicator, const GlobalGraph& graph,
                                       const HaloValues<GlobalIndex>& place_of);

}  // namespace meshorder::distributed
