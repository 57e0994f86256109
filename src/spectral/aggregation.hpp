// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/laplacian.hpp"
#include "spectral/row_chunks.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// A partition of a graph's vertices into aggregates, which are the vertices of the next coarser graph. The
/// aggregates are numbered chunk after chunk of the rows.
struct Aggregation {
  std::vector<Index> aggregate_of;       ///< n entries in 0 … count−1
  std::vector<Index> first_of_chunk{0};  ///< the first aggregate of each chunk, then the number of aggregates

  Index alone = 0;  ///< number of aggregates of a single vertex without strong neighbours in its chunk
  std::vector<Index> founders = {};  ///< one for each aggregate
  double strength = 0;               ///< threshold for strong neighbours, see `aggregate`
  std::vector<double> slacks = {};   ///< how much vectors may vary within each aggregate, see `aggregate`

  [[nodiscard]] Index count() const { return first_of_chunk.back(); }
};

/// Aggregates greedily (Vaněk, Mandel, Brezina 1996) within each chunk of rows, all chunks at the same time:
/// each vertex whose strong neighbours are all free founds an aggregate with them; other vertices join the
/// aggregate of their strongest neighbour. A neighbour is strong if its weight is at least `strength` times
/// the largest weight of the row. Vertices are visited in index order. O(n + edges); the result is the same
/// for any number of threads.
///
/// Every vertex joins its aggregate through one edge, which leads to the founder or to a founding member. The
/// slack of an aggregate is the largest ratio, over these edges, of the mass that depends on an edge to the
/// edge's weight. A vector of Rayleigh quotient λ is nearly constant on an aggregate if λ · slack is much
/// less than 1. Otherwise the aggregate may hide a vector: for example, an aggregate of two cliques joined by
/// a bridge has a large mass that depends on the bridge. See hiding.hpp.
///
/// @param masses  of the vertices; empty if all are 1
Aggregation aggregate(const Laplacian& laplacian, const RowChunks& chunks, double strength,
                      std::span<const double> masses = {});

/// Returns the least weight of a strong neighbour of v. O(neighbours of v).
double strong_weight(const Laplacian& laplacian, Index v, double strength);

/// The vertices of aggregates: aggregate a has `members[starts[a]] … members[starts[a + 1] − 1]`, ascending.
struct Members {
  std::vector<Index> starts;
  std::vector<Index> members;

  [[nodiscard]] std::span<const Index> of(Index aggregate) const {
    return std::span(members).subspan(starts[aggregate], starts[aggregate + 1] - starts[aggregate]);
  }
};

/// Returns the vertices 0 … rows−1 of each aggregate.
Members members_of(const Aggregation& aggregation, Index rows);

}  // namespace meshorder
