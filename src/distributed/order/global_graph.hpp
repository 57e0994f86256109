// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <vector>

namespace meshorder::distributed {

/// The rows that a rank owns of an undirected graph: rising numbers of neighbours on any rank, no loops, no
/// repeats; every edge in the rows of both its ends. The arrays are those that PT-Scotch takes.
struct GlobalGraph {
  Layout layout;  ///< of the vertices
  Rows rows;      ///< the neighbours of the own ones
};

/// Builds the graph that joins any two vertices of a common element, from elements that are anywhere. Every
/// rank has to call it. O(sum of element sizes squared · log degree).
///
/// @param layout    of the vertices
/// @param elements  vertices of the elements that this rank has; each element on one rank. Taken: they would
///                  need as much memory as the graph
/// @throws SharedError where the rows of a rank have more than 2,147,483,647 vertices, and where a rank has
/// no
///         memory
[[nodiscard]] GlobalGraph global_graph(const Communicator& communicator, const Layout& layout, Rows elements);

/// Returns the neighbours of own vertices that other ranks own, ascending, each once.
[[nodiscard]] std::vector<GlobalIndex> ghosts(const GlobalGraph& graph, int rank);

}  // namespace meshorder::distributed
