// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/examine.hpp"
#include "graph/graph_arrays.hpp"
#include <meshorder/options.hpp>

#include <vector>

namespace meshorder {

/// A graph that owns its arrays: n + 1 offsets from 0, neighbours, and a weight for each neighbour or none.
struct OwnedGraph {
  std::vector<Offset> offsets;
  std::vector<Index> neighbours;
  std::vector<double> weights;

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

/// Returns a clean form of a caller's graph: ascending rows, no loops, no repeats, every edge in the rows of
/// both ends. Copies no arrays that are clean and of the library's types; `notes` report what was changed.
///
/// @param check     full, fast: see `Check`; fast mirrors an asymmetric pattern. none: only converts types,
///                  unless `symmetry` is mirror
/// @param symmetry  mirror: an asymmetric graph gets the pattern of A + Aᵀ and the weights of (A + Aᵀ) / 2
/// @throws InvalidArgument, TooLarge as `meshorder::check`
/// @note O(n + entries · log degree), on all threads of the arena.
GraphArrays clean_graph(const GraphView& graph, Check check, Symmetry symmetry);

/// Returns a copy with ascending rows, without loops and repeats. The numbers of the graph must be in range.
/// Weights of repeats are added in ascending order, so that both rows of an edge get the same bits. O(n +
/// entries · log degree); O(n · log degree + entries) if rows ascend.
///
/// @param findings  what `examine` found in the graph
OwnedGraph cleaned_copy(const GraphArrays& graph, const GraphFindings& findings);

/// Returns the clean graph of A + Aᵀ, with weights of (A + Aᵀ) / 2. O(n + entries · log degree).
OwnedGraph mirrored_copy(const GraphArrays& graph);

}  // namespace meshorder
