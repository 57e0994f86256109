// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include <meshorder/layouts.hpp>
#include <meshorder/permutation.hpp>

#include <cstdint>
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

/// Returns requests and sectors of threads that add to vertices one after another: a warp adds to 32 of them
/// at once.
///
/// @param ascending  different vertices in ascending order
GpuCost additions_to(std::span<const Index> ascending, GpuLayout layout);

/// What loops over lists load, with one thread for each list or several.
struct ListLoads {
  Offset requests = 0;  ///< steps of a warp
  Offset lists = 0;     ///< sectors of an array that has 4 bytes for each entry of the lists
  Offset records = 0;   ///< sectors of the records that the entries name

  ListLoads& operator+=(const ListLoads& other);
};

/// Lists one after another, and the records that their entries name.
struct RecordLists {
  std::span<const Offset> offsets;             ///< lists + 1
  std::span<const Index> records;              ///< the record of each entry; empty: see `cells`
  int record_bytes = 4;                        ///< 4, 8, 16 or 32
  std::span<const Index> cells = {};           ///< entry i names record cells[i] · width + corners[i]
  std::span<const std::uint8_t> corners = {};  ///< likewise
  int width = 1;

  [[nodiscard]] Offset record(Offset entry) const {
    return cells.empty() ? Offset{records[entry]} : Offset{cells[entry]} * width + corners[entry];
  }
};

/// Counts what the threads of a warp load at once. Each takes every `lanes`-th entry of its list, in a loop
/// as NVIDIA's compiler unrolls it: first the entries left over by a division by four, then 16 at a time
/// while more than 12 are left, then 8 if more than 4 are left, then 4. O(entries), on all threads.
///
/// @param lanes  threads of each list: 1, 2, 4, 8, 16 or 32
ListLoads loads_of_lists(const RecordLists& lists, int lanes);

/// Returns the sectors of the vector (4 bytes a number) that a matrix-vector product reads with one thread a
/// row, as `loads_of_lists` counts them. The matrix has a diagonal. O(entries counted · log degree).
///
/// @param order   of rows and neighbours
/// @param stride  every stride-th warp is looked at, ≥ 1
Offset sectors_of_product(GraphRef graph, const Permutation& order, Index stride = 1);

}  // namespace meshorder
