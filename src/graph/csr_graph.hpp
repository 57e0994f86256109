// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// An undirected graph in compressed sparse rows: the neighbours of vertex v are
/// `neighbours[offsets[v]] … neighbours[offsets[v + 1] − 1]`, ascending, without v itself and without
/// repeats. Every edge is in the rows of both its ends.
struct CsrGraph {
  std::vector<Offset> offsets{0};  ///< n + 1
  std::vector<Index> neighbours;   ///< twice the number of edges

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] Offset edge_count() const noexcept { return static_cast<Offset>(neighbours.size() / 2); }
  [[nodiscard]] Index degree(Index v) const { return static_cast<Index>(offsets[v + 1] - offsets[v]); }
  [[nodiscard]] std::span<const Index> operator[](Index v) const {
    return {neighbours.data() + offsets[v], neighbours.data() + offsets[v + 1]};
  }
  bool operator==(const CsrGraph&) const = default;
};

/// A view of a clean undirected graph; the algorithms take graphs in this form. Refers to the arrays of a
/// `CsrGraph`, or to a caller's arrays in the same form. A copy takes four words.
struct GraphRef {
  std::span<const Offset> offsets;    ///< n + 1, from 0
  std::span<const Index> neighbours;  ///< twice the number of edges

  GraphRef(std::span<const Offset> row_offsets, std::span<const Index> row_neighbours)
      : offsets(row_offsets), neighbours(row_neighbours) {}
  GraphRef(const CsrGraph& graph)  // NOLINT(google-explicit-constructor)
      : offsets(graph.offsets), neighbours(graph.neighbours) {}

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] Offset edge_count() const noexcept { return static_cast<Offset>(neighbours.size() / 2); }
  [[nodiscard]] Index degree(Index v) const { return static_cast<Index>(offsets[v + 1] - offsets[v]); }
  [[nodiscard]] std::span<const Index> operator[](Index v) const {
    return {neighbours.data() + offsets[v], neighbours.data() + offsets[v + 1]};
  }
};

/// An edge given by its two ends.
struct Edge {
  Index a;
  Index b;
};

/// Returns the graph of vertices 0 … n−1 with these edges; drops loops and merges repeats. Throws
/// InvalidArgument for an end outside 0 … n−1. O(n + edges · log degree).
CsrGraph graph_from_edges(Index n, std::span<const Edge> edges);

/// Returns the graph with vertex v renamed `old_to_new[v]`, a bijection. O(n + edges · log degree).
CsrGraph renumbered(GraphRef graph, std::span<const Index> old_to_new);

/// Returns the subgraph of the listed vertices (each once): vertex k of the result is `vertices[k]`. Edges
/// to other vertices are dropped. O(n of `graph` + entries of the listed rows · log degree).
CsrGraph induced_subgraph(GraphRef graph, std::span<const Index> vertices);

/// Sorts every row of compressed sparse rows, drops repeats, drops loops unless `keeps_loops`, and closes the
/// gaps. O(entries · log row length).
///
/// @param starts  rows + 1
void tidy_rows(std::vector<Offset>& starts, std::vector<Index>& columns, bool keeps_loops);

}  // namespace meshorder
