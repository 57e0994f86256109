// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/laplacian.hpp"
#include "spectral/row_chunks.hpp"

#include <vector>

namespace meshorder {

/// A partition of the vertices into groups, the vertices of the next coarser graph. The aggregates of a chunk
/// of rows are numbered together, chunk after chunk.
struct Aggregation {
  std::vector<Index> aggregate_of;       ///< n entries in 0 … count−1
  std::vector<Index> first_of_chunk{0};  ///< the first aggregate of each chunk, and their number at the end

  Index alone = 0;  ///< how many vertices are aggregates of one, without a strong neighbour in their chunk

  [[nodiscard]] Index count() const { return first_of_chunk.back(); }
};

/// Greedy aggregation (Vaněk, Mandel, Brezina 1996) within each chunk of rows, all chunks at the same time:
/// each vertex whose strong neighbours are all free founds an aggregate with them; the rest joins the
/// aggregate of its strongest neighbour. A neighbour is strong when its weight is at least `strength` times
/// the largest of the row. O(n + edges), in index order, the same for any number of threads.
Aggregation aggregate(const Laplacian& laplacian, const RowChunks& chunks, double strength);

}  // namespace meshorder
