// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/graph/laplacian.hpp>

#include <vector>

namespace meshorder {

/// A partition of the vertices into connected groups, the vertices of the next coarser graph.
struct Aggregation {
  std::vector<Index> aggregate_of;  ///< n entries in 0 … count−1
  Index count = 0;
};

/// Greedy aggregation (Vaněk, Mandel, Brezina 1996): each vertex whose strong neighbours are all free founds
/// an aggregate with them; the rest joins the aggregate of its strongest neighbour. A neighbour is strong
/// when its weight is at least `strength` times the largest of the row. O(n + edges), in index order,
/// deterministic.
Aggregation aggregate(const Laplacian& laplacian, double strength);

}  // namespace meshorder
