// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"
#include <meshorder/fiedler.hpp>
#include <meshorder/options.hpp>

#include <vector>

namespace meshorder::distributed {

/// Problem sizes up to which one rank works alone.
struct SharedSizes {
  GlobalIndex alone = 50'000;  ///< maximum size of a component on several ranks that one rank solves
  GlobalIndex few = 50'000;    ///< maximum number of coarse vertices at the root; vertices / ranks if larger
};

/// The order of a distributed graph by its Fiedler vector.
struct SharedFiedlerOrder {
  std::vector<GlobalIndex> new_numbers;      ///< new number of the vertex of each row of the graph
  std::vector<FiedlerComponent> components;  ///< reports on all components, largest first; at the root only
};

/// Orders a graph as the serial `fiedler` does. Components follow each other, largest first, ties by their
/// smallest vertices. Within a component the entries of its Fiedler vector ascend, ties by number. Every rank
/// has to call it. O(entries · iterations).
///
/// All ranks solve a large component that is on several ranks; the rank of the smallest vertex solves any
/// other component. The order depends only on the graph and the number of ranks, not on the number of
/// threads.
///
/// @param halo            halo of the graph's ghosts: neighbours that other ranks own
/// @param number_in_file  number in the file of each vertex of this rank. These numbers fix the sign as in
///                        the serial order: among the entries with at least half of the largest magnitude,
///                        the first in the file is negative
/// @param options         tolerance, max_iterations and seed
/// @throws SharedError unless the tolerance is positive and finite and max_iterations ≥ 1; as
///         `Communicator::exchange`
[[nodiscard]] SharedFiedlerOrder fiedler_order(const Communicator& communicator, const GlobalGraph& graph,
                                               const Halo& halo,
                                               const std::vector<GlobalIndex>& number_in_file,
                                               const OrderOptions& options, SharedSizes sizes = {});

}  // namespace meshorder::distributed
