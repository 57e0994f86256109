// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"
#include <meshorder/options.hpp>

#include <vector>

namespace meshorder::distributed {

/// Cuts a graph into parts by recursive spectral bisection (Simon 1991: Partitioning of unstructured problems
/// for parallel processing). Each round cuts every piece in two by the order of its Fiedler vector, until
/// there are enough parts. One call of `fiedler_order` orders all pieces of a round, in the graph without the
/// edges between pieces. A round increases the difference of the parts' weights by one vertex's weight at
/// most. Returns the same parts for the same graph on the same number of ranks. Every rank has to call it.
/// O(log parts) Fiedler vectors.
///
/// @param halo            halo of the graph's ghosts: neighbours that other ranks own
/// @param number_in_file  as in `fiedler_order`
/// @param parts           ≥ 1
/// @param weights         weight > 0 of each vertex of this rank; empty on all ranks: all 1
/// @param options         as in `fiedler_order`
/// @return the part of each vertex of this rank
/// @throws as `fiedler_order`
[[nodiscard]] std::vector<Index> bisected(const Communicator& communicator, const GlobalGraph& graph,
                                          const Halo& halo, const std::vector<GlobalIndex>& number_in_file,
                                          Index parts, const std::vector<GlobalIndex>& weights,
                                          const OrderOptions& options);

}  // namespace meshorder::distributed
