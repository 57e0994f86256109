// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"
#include <meshorder/options.hpp>

#include <vector>

namespace meshorder::distributed {

/// Cuts a graph into parts by recursive spectral bisection (Simon 1991: Partitioning of unstructured problems
/// for parallel processing): in two by the order of its Fiedler vector, and so each half, until there are
/// enough. All pieces of a round are ordered by one call, whose components they are. Parts differ in weight
/// by a vertex a round at most. The same parts for the same graph on the same number of ranks. Every rank has
/// to call it. O(log parts) Fiedler vectors.
///
/// @param halo            of the graph's ghosts
/// @param number_in_file  as of `fiedler_order`
/// @param parts           ≥ 1
/// @param weights         > 0, of each own vertex; none on any rank: all alike
/// @param options         as of `fiedler_order`
/// @return the part of each own vertex
/// @throws as `fiedler_order`
[[nodiscard]] std::vector<Index> bisected(const Communicator& communicator, const GlobalGraph& graph,
                                          const Halo& halo, const std::vector<GlobalIndex>& number_in_file,
                                          Index parts, const std::vector<GlobalIndex>& weights,
                                          const OrderOptions& options);

}  // namespace meshorder::distributed
