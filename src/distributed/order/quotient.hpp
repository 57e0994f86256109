// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"

#include <vector>

namespace meshorder::distributed {

/// An order of the parts of a graph.
struct Quotient {
  std::vector<Index> place_of;  ///< place of each part in the order
  GlobalIndex cut = 0;          ///< number of edges between parts
};

/// Orders the parts by the Fiedler vector of their quotient graph, whose weights are the numbers of edges
/// between parts, and then moves single parts while that brings strongly joined parts nearer. Every rank has
/// to call it; the root solves. O(entries + cut · log cut).
///
/// @param part_of  part of each vertex in the graph's rows, 0 … parts − 1
/// @throws as `Communicator::exchange`
[[nodiscard]] Quotient order_of_parts(const Communicator& communicator, const GlobalGraph& graph,
                                      const HaloValues<Index>& part_of, Index parts);

}  // namespace meshorder::distributed
