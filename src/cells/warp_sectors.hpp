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
  std::span<const Index> new_to_old = {};         ///< empty: the elements keep their order
  std::span<const Index> vertex_old_to_new = {};  ///< empty: the vertices keep their numbers
};

/// Returns the sectors of atomic additions to the vertices of elements, counted as in `GpuCost::sectors`,
/// with one GPU thread for each element. O(entries) time, on all threads.
///
/// @param stride  only every stride-th warp is counted, ≥ 1
Offset sectors_of_additions(const ElementOrder& order, GpuLayout layout, Index stride = 1);

/// Returns `GpuCost::requests` and `floor` of elements with `width` vertices each. O(width).
GpuCost requests_and_floor(Index elements, int width, GpuLayout layout);

/// Returns the requests and sectors of adding to a list of vertices: each warp adds to the next 32 vertices
/// at once.
///
/// @param ascending  different vertices in ascending order
GpuCost additions_to(std::span<const Index> ascending, GpuLayout layout);

/// What warps load when one or several threads loop over each list.
struct ListLoads {
  Offset requests = 0;  ///< steps of warps; in each, the active threads load one entry
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
  std::span<const std::uint8_t> corners = {};  ///< see `cells`
  int width = 1;

  [[nodiscard]] Offset record(Offset entry) const {
    return cells.empty() ? Offset{records[entry]} : Offset{cells[entry]} * width + corners[entry];
  }
};

/// Counts what the threads of a warp load at once. Each thread takes every `lanes`-th entry of its list, in a
/// loop as NVIDIA's compiler unrolls it. A thread that has k entries reads:
/// 1. k mod 4 entries, one at a time;
/// 2. 16 entries at a time while more than 12 remain;
/// 3. 8 entries if more than 4 remain;
/// 4. 4 entries if any remain.
///
/// O(entries) time, on all threads.
///
/// @param lanes  threads of each list: 1, 2, 4, 8, 16 or 32
ListLoads loads_of_lists(const RecordLists& lists, int lanes);

/// Returns the number of sectors of the vector (4 bytes a number) that a matrix-vector product with one
/// thread per row reads, counted as by `loads_of_lists`. The matrix has a diagonal. O(entries of the counted
/// rows · log degree) time.
///
/// @param order   order of the rows and columns
/// @param stride  only every stride-th warp is counted, ≥ 1
Offset sectors_of_product(GraphRef graph, const Permutation& order, Index stride = 1);

}  // namespace meshorder
