// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <vector>

namespace meshorder::distributed {

/// This rank's rows of an undirected graph. A row has the ascending global numbers of the neighbours, without
/// loops and repeats. Every edge is in the rows of both its ends. PT-Scotch reads `rows.entries` without
/// conversion.
struct GlobalGraph {
  Layout layout;  ///< the owners of the vertices
  Rows rows;      ///< the neighbours of each vertex of this rank
};

/// Builds the graph that joins any two vertices of a common element. Elements may be on any rank. Every rank
/// has to call it. O(sum of element sizes squared · log degree).
///
/// @param layout    the owners of the vertices
/// @param elements  vertices of each element on this rank; freed before the graph is built, because they take
///                  as much memory as the graph
/// @throws SharedError if the elements at a rank's vertices have more than 2,147,483,647 different vertices,
///         or if a rank lacks memory
[[nodiscard]] GlobalGraph global_graph(const Communicator& communicator, const Layout& layout, Rows elements);

/// Returns the ghosts: neighbours of this rank's vertices that other ranks own; ascending, each once.
[[nodiscard]] std::vector<GlobalIndex> ghosts(const GlobalGraph& graph, int rank);

/// As `EdgeSpan`, for 64-bit numbers.
struct GlobalEdgeSpan {
  double mean = 0;
  GlobalIndex max = 0;
  double mean_log2 = 0;
};

/// Returns the spans of a graph's edges in an order. Every rank has to call it. O(entries).
///
/// @param place_of  position of each vertex in the order
/// @throws as `Communicator::exchange`
[[nodiscard]] GlobalEdgeSpan edge_span(const Communicator& communicator, const GlobalGraph& graph,
                                       const HaloValues<GlobalIndex>& place_of);

}  // namespace meshorder::distributed
