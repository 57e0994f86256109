// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <span>

namespace meshorder {

// What asks for compressed rows that a loop comes to a few steps later: they lie anywhere in memory.

/// Asks for the row of the vertex that stands a few places after `k` in the order.
inline void prefetch_row(GraphRef graph, std::span<const Index> order, Index k) {
  constexpr Index kAhead = 8;
  if (k + kAhead < index_size(order)) {
    __builtin_prefetch(graph.neighbours.data() + graph.offsets[order[k + kAhead]]);
  }
}

/// Asks for the places where rows begin, for `prefetch_rows` to find them in the cache a step later.
inline void prefetch_offsets(std::span<const Offset> offsets, std::span<const Index> rows) {
  for (const Index row : rows) __builtin_prefetch(offsets.data() + row);
}

/// Asks for the first two lines of the rows, which hold 17 entries or more.
inline void prefetch_rows(std::span<const Offset> offsets, std::span<const Index> entries,
                          std::span<const Index> rows) {
  if (entries.empty()) return;
  constexpr Offset kLine = 64 / sizeof(Index);
  for (const Index row : rows) {
    const Index* const first = entries.data() + offsets[row];
    __builtin_prefetch(first);
    __builtin_prefetch(first + kLine);
  }
}

}  // namespace meshorder
