// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <span>

namespace meshorder {

// Loops over vertices visit rows anywhere in memory and search them; the results are unpredictable.
// These functions prefetch rows a few steps ahead, and search without branches.

/// Prefetches the first two cache lines of a row, which hold at least 17 entries.
inline void prefetch_entries(const Index* row) {
  constexpr Offset kLine = 64 / sizeof(Index);
  __builtin_prefetch(row);
  __builtin_prefetch(row + kLine);
}

/// Prefetches the row of the vertex that comes a few places after `k` in the order.
inline void prefetch_row(GraphRef graph, std::span<const Index> order, Index k) {
  constexpr Index kAhead = 8;
  if (k + kAhead < index_size(order) && !graph.neighbours.empty()) {
    prefetch_entries(graph.neighbours.data() + graph.offsets[order[k + kAhead]]);
  }
}

/// Prefetches the offsets of rows, so that `prefetch_rows` finds them in the cache a step later.
inline void prefetch_offsets(std::span<const Offset> offsets, std::span<const Index> rows) {
  for (const Index row : rows) __builtin_prefetch(offsets.data() + row);
}

/// Prefetches the rows as `prefetch_entries` does.
inline void prefetch_rows(std::span<const Offset> offsets, std::span<const Index> entries,
                          std::span<const Index> rows) {
  if (entries.empty()) return;
  for (const Index row : rows) prefetch_entries(entries.data() + offsets[row]);
}

/// Returns the number of entries of a rising row that are less than `value`: std::lower_bound without
/// branches, which would be unpredictable. O(log row length).
[[nodiscard]] inline Index entries_below(std::span<const Index> row, Index value) {
  Index left = index_size(row);
  Index below = 0;
  while (left > 0) {
    const Index half = (left + 1) / 2;
    below += row[below + half - 1] < value ? half : 0;
    left -= half;
  }
  return below;
}

}  // namespace meshorder
