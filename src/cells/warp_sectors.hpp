// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include <meshorder/layouts.hpp>
#include <meshorder/permutation.hpp>

#include <span>

namespace meshorder {

// Counts of the 32-byte sectors that the 32 threads of a warp of a graphics processor touch at once.

inline constexpr Index kWarp = 32;

/// Elements in an order.
struct ElementOrder {
  IncidenceRef elements;
  std::span<const Index> new_to_old = {};         ///< empty: as they are numbered
  std::span<const Index> vertex_old_to_new = {};  ///< likewise
};

/// Returns the sectors of atomic additions to the vertices of elements, with one thread for each element, as
/// `GpuCost::sectors` counts them. O(entries), on all threads.
///
/// @param stride  every stride-th warp is looked at, ≥ 1
Offset sectors_of_additions(const ElementOrder& order, GpuLayout layout, Index stride = 1);

/// Returns `GpuCost::requests` and `floor` of elements with `width` vertices each. O(width).
GpuCost requests_and_floor(Index elements, int width, GpuLayout layout);

/// Returns the sectors of the vector (4 bytes a number) that a matrix-vector product reads with one thread a
/// row. At each step every thread of a warp reads the number of its row's next neighbour. O(entries counted).
///
/// @param order   of rows and neighbours
/// @param stride  every stride-th warp is looked at, ≥ 1
Offset sectors_of_product(GraphRef graph, const Permutation& order, Index stride = 1);

}  // namespace meshorder
