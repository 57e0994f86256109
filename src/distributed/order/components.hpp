// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"
#include "spectral/component_numbering.hpp"

#include <vector>

namespace meshorder::distributed {

/// A connected component of a graph, and the rank that computes its Fiedler vector.
struct Component {
  GlobalIndex place;  ///< position by size, from 0 for the largest; ties by the smallest vertex
  GlobalIndex start;  ///< number of vertices in components of lower `place`
  GlobalIndex size;   ///< number of vertices, ≥ 1
  int solver;         ///< the only rank that solves the component, or `kAllRanks`
};

constexpr int kAllRanks = -1;

/// The components with vertices on this rank, and the components that all ranks solve.
struct Components {
  ComponentNumbering pieces;            ///< pieces: components of the subgraph of this rank's vertices
  std::vector<Component> of_piece;      ///< the component of each piece
  std::vector<Component> of_all_ranks;  ///< components that all ranks solve; the same on all ranks
};

/// Finds the components of a graph. A component on several ranks with more than `alone` vertices is solved by
/// all ranks, any other by the rank of its smallest vertex. Every rank has to call it. O(entries), and
/// O(pieces of all ranks) at the root.
///
/// @param halo   halo of the graph's ghosts: neighbours that other ranks own
/// @throws as `Communicator::exchange`
[[nodiscard]] Components components_of(const Communicator& communicator, const GlobalGraph& graph,
                                       const Halo& halo, GlobalIndex alone);

}  // namespace meshorder::distributed
