// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/laplacian.hpp"
#include "spectral/row_chunks.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// A partition of the vertices into groups, the vertices of the next coarser graph. The aggregates of a chunk
/// of rows are numbered together, chunk after chunk.
struct Aggregation {
  std::vector<Index> aggregate_of;       ///< n entries in 0 … count−1
  std::vector<Index> first_of_chunk{0};  ///< the first aggregate of each chunk, and their number at the end

  Index alone = 0;  ///< how many vertices are aggregates of one, without a strong neighbour in their chunk
  std::vector<Index> founders = {};  ///< of the aggregates
  double strength = 0;               ///< what makes neighbours strong, see `aggregate`
  std::vector<double> slacks = {};   ///< how much vectors may vary within each aggregate, see `aggregate`

  [[nodiscard]] Index count() const { return first_of_chunk.back(); }
};

/// Greedy aggregation (Vaněk, Mandel, Brezina 1996) within each chunk of rows, all chunks at the same time:
/// each vertex whose strong neighbours are all free founds an aggregate with them; the rest joins the
/// aggregate of its strongest neighbour. A neighbour is strong when its weight is at least `strength` times
/// the largest of the row. O(n + edges), in index order, the same for any number of threads.
///
/// Every vertex comes to its aggregate through an edge, to the founder or to a founding member. The slack of
/// an aggregate is the largest mass that hangs on such an edge, divided by the edge's weight. A vector of
/// Rayleigh quotient λ is nearly constant on an aggregate where λ · slack is much less than 1. Where it is
/// not, the aggregate may hide a vector: two cliques that a bridge joins, in one aggregate, hang on that
/// bridge. See hiding.hpp.
///
/// @param masses  of the vertices; none: all 1
Aggregation aggregate(const Laplacian& laplacian, const RowChunks& chunks, double strength,
                      std::span<const double> masses = {});

/// The least weight of a strong neighbour of v. O(neighbours of v).
double strong_weight(const Laplacian& laplacian, Index v, double strength);

/// Vertices by aggregate: those of a are `members[starts[a]] … members[starts[a + 1] − 1]`, ascending.
struct Members {
  std::vector<Index> starts;
  std::vector<Index> members;

  [[nodiscard]] std::span<const Index> of(Index aggregate) const {
    return std::span(members).subspan(starts[aggregate], starts[aggregate + 1] - starts[aggregate]);
  }
};

/// @param rows  the vertices 0 … rows−1 alone are listed
Members members_of(const Aggregation& aggregation, Index rows);

}  // namespace meshorder
