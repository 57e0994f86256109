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

  Index alone = 0;   ///< how many vertices are aggregates of one, without a strong neighbour in their chunk
  double slack = 0;  ///< how much vectors may vary within an aggregate, see `aggregate`

  [[nodiscard]] Index count() const { return first_of_chunk.back(); }
};

/// Greedy aggregation (Vaněk, Mandel, Brezina 1996) within each chunk of rows, all chunks at the same time:
/// each vertex whose strong neighbours are all free founds an aggregate with them; the rest joins the
/// aggregate of its strongest neighbour. A neighbour is strong when its weight is at least `strength` times
/// the largest of the row. O(n + edges), in index order, the same for any number of threads.
///
/// Every vertex comes to its aggregate through an edge, to the founder or to a founding member. `slack` is
/// the largest mass that hangs on such an edge, divided by the edge's weight. A vector of Rayleigh quotient λ
/// is nearly constant on all aggregates where λ · slack is much less than 1. Where it is not, an aggregate
/// may hide a vector: two cliques that a bridge joins, in one aggregate, hang on that bridge.
///
/// @param masses  of the vertices; none: all 1
Aggregation aggregate(const Laplacian& laplacian, const RowChunks& chunks, double strength,
                      std::span<const double> masses = {});

}  // namespace meshorder
