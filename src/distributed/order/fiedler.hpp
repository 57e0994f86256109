// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"
#include <meshorder/fiedler.hpp>
#include <meshorder/options.hpp>

#include <vector>

namespace meshorder::distributed {

/// Sizes from which ranks work together.
struct SharedSizes {
  GlobalIndex alone = 50'000;  ///< vertices of a component that one rank solves at most
  GlobalIndex few = 50'000;    ///< coarse vertices that go to the root, or as many as a rank has if more
};

/// The order by the Fiedler vector of a graph that the ranks share.
struct SharedFiedlerOrder {
  std::vector<GlobalIndex> new_numbers;      ///< of the vertices in the graph's rows
  std::vector<FiedlerComponent> components;  ///< of all ranks, largest first; at the root
};

/// Orders a graph as the serial `fiedler` does: component after component, largest first, ties by their
/// smallest vertices, each by ascending entries of its Fiedler vector, ties by number. Every rank has to call
/// it. O(entries · iterations).
///
/// A component on several ranks with many vertices is solved by all of them, another one by the rank of its
/// smallest vertex. The same order for the same graph and number of ranks, whatever the number of threads.
///
/// @param halo            of the graph's ghosts
/// @param number_in_file  of each own vertex: the first by this that reaches half of a vector's largest
///                        magnitude is negative, as in the serial order
/// @param options         tolerance, max_iterations and seed
/// @throws SharedError for a tolerance or number of iterations that is not positive; as
///         `Communicator::exchange`
[[nodiscard]] SharedFiedlerOrder fiedler_order(const Communicator& communicator, const GlobalGraph& graph,
                                               const Halo& halo,
                                               const std::vector<GlobalIndex>& number_in_file,
                                               const OrderOptions& options, SharedSizes sizes = {});

}  // namespace meshorder::distributed
