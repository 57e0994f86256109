// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"
#include "spectral/component_numbering.hpp"

#include <vector>

namespace meshorder::distributed {

/// A connected component of a graph, and who finds its Fiedler vector.
struct Component {
  GlobalIndex place;  ///< 0 … components − 1: the largest first, ties by their smallest vertices
  GlobalIndex start;  ///< vertices of those before it
  GlobalIndex size;   ///< vertices, ≥ 1
  int solver;         ///< the rank that does so alone, or `kAllRanks`
};

constexpr int kAllRanks = -1;

/// The components of a graph, as a rank sees them.
struct Components {
  ComponentNumbering pieces;            ///< what its own vertices are joined to by own vertices
  std::vector<Component> of_piece;      ///< of each piece
  std::vector<Component> of_all_ranks;  ///< those that all ranks solve together; the same on all
};

/// Finds the components of a graph. Those on several ranks with more vertices than `alone` are for all ranks,
/// any other for the rank of its smallest vertex. Every rank has to call it. O(entries), and
/// O(pieces of all ranks) at the root.
///
/// @param halo   of the graph's ghosts
/// @throws as `Communicator::exchange`
[[nodiscard]] Components components_of(const Communicator& communicator, const GlobalGraph& graph,
                                       const Halo& halo, GlobalIndex alone);

}  // namespace meshorder::distributed
