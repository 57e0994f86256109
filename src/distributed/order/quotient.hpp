// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"

#include <vector>

namespace meshorder::distributed {

/// The graph of the parts: two are joined by as many edges as there are between them.
struct Quotient {
  std::vector<Index> place_of;  ///< of each part in the order of the parts
  GlobalIndex cut = 0;          ///< edges between parts
};

/// Numbers the parts by the Fiedler vector of their graph, and moves single parts as long as that brings
/// those with many edges between them nearer. Every rank has to call it; the root solves. O(entries + edges
/// between parts · log).
///
/// @param part_of  part of each vertex in the graph's rows, 0 … parts − 1
/// @throws as `Communicator::exchange`
[[nodiscard]] Quotient order_of_parts(const Communicator& communicator, const GlobalGraph& graph,
                                      const HaloValues<Index>& part_of, Index parts);

}  // namespace meshorder::distributed
