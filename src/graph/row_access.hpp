// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>

namespace meshorder {

// Loops over vertices read rows all over memory and branch on their entries unpredictably. These functions
// prefetch rows a few steps ahead, and search without branches.
//
// GCC 12 drops calls of functions that only prefetch, unless they are inlined early.

/// Prefetches the first two cache lines of a row, which hold at least 17 entries.
[[gnu::always_inline]] inline void prefetch_entries(const Index* row) {
  constexpr Offset kLine = 64 / sizeof(Index);
  __builtin_prefetch(row);
  __builtin_prefetch(row + kLine);
}

/// Prefetches for a loop that reads the rows of vertices in `order` and has reached place k: the offset of
/// the row 48 places ahead, and the row 24 places ahead.
[[gnu::always_inline]] inline void prefetch_row(GraphRef graph, std::span<const Index> order, Index k) {
  constexpr Index kOffsetAhead = 48;
  constexpr Index kRowAhead = 24;
  if (graph.neighbours.empty()) return;  // no address to count from
  const Index last = index_size(order) - 1;
  __builtin_prefetch(graph.offsets.data() + order[k + std::min(kOffsetAhead, last - k)]);
  prefetch_entries(graph.neighbours.data() + graph.offsets[order[k + std::min(kRowAhead, last - k)]]);
}

/// Like the other `prefetch_row`; also prefetches `numbers[u]` for the entries u of the row 6 places ahead.
[[gnu::always_inline]] inline void prefetch_row(GraphRef graph, std::span<const Index> order, Index k,
                                                const Index* numbers) {
  constexpr Index kNumbersAhead = 6;
  constexpr std::size_t kMost = 32;  // neighbours; longer rows keep the processor busy by themselves
  prefetch_row(graph, order, k);
  const std::span<const Index> row = graph[order[k + std::min(kNumbersAhead, index_size(order) - 1 - k)]];
  for (const Index u : row.first(std::min(row.size(), kMost))) __builtin_prefetch(numbers + u);
}

/// Calls `visit(u)` for the entries u of a row with `numbers[u] < limit`, in their order. Compares up to 32
/// entries before it visits any, because a processor cannot predict which ones are visited: a repeated entry
/// may be visited twice. Other threads may write numbers.
template <class Visit>
void for_each_below(std::span<const Index> row, std::span<Index> numbers, Index limit, const Visit& visit) {
  constexpr std::size_t kAtOnce = 32;
  for (; !row.empty(); row = row.subspan(std::min(row.size(), kAtOnce))) {
    const std::span<const Index> some = row.first(std::min(row.size(), kAtOnce));
    std::uint32_t below = 0;  // a bit for each entry
    for (std::size_t i = 0; i < some.size(); ++i) {
      const Index number = std::atomic_ref(numbers[some[i]]).load(std::memory_order_relaxed);
      below |= std::uint32_t{number < limit} << i;
    }
    for (; below != 0; below &= below - 1) visit(some[std::size_t(std::countr_zero(below))]);
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

/// Returns the number of entries of an ascending row that are less than `value`, like std::lower_bound but
/// without unpredictable branches. O(log row length).
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
