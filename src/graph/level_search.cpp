// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/level_search.hpp"

#include "base/parallel.hpp"
#include "graph/row_access.hpp"

#include <algorithm>
#include <atomic>

namespace meshorder {

Index LevelSearch::run(Index start, std::span<Index> places, Arrange arrange) {
  constexpr Index kToShare = 2048;  // least size of a level for which other threads are started
  level_start_.clear();
  places[0] = start;
  found_by_[start] = -1;  // before all places
  Index found = 1;
  for (Index begin = 0; begin < found;) {
    level_start_.push_back(begin);
    const Index end = found;
    found = end - begin >= kToShare && thread_count() > 1
                ? find_next_level_together(places, begin, end, arrange)
                : find_next_level(places, begin, end, arrange);
    begin = end;
  }
  level_start_.push_back(found);
  return found;
}

void LevelSearch::forget(Index first, Index end) {
  std::fill(found_by_.begin() + first, found_by_.begin() + end, kNobody);
}

/// Writes every neighbour to the end of `places`, and moves the end only for new ones. This takes no branch:
/// a processor cannot predict whether a vertex has been found before.
Index LevelSearch::find_next_level(std::span<Index> places, Index begin, Index end, Arrange arrange) {
  Index found = end;
  for (Index k = begin; k < end; ++k) {
    poll_in_loop(k);
    prefetch_row(graph_, places.first(static_cast<std::size_t>(found)), k);
    const Index first = found;
    for (const Index u : graph_[places[k]]) {
      places[found] = u;
      const bool is_new = found_by_[u] == kNobody;
      found_by_[u] = is_new ? k : found_by_[u];
      found += is_new ? 1 : 0;
    }
    if (arrange != nullptr && found - first > 1) arrange(graph_, places.subspan(first, found - first));
  }
  return found;
}

Index LevelSearch::find_next_level_together(std::span<Index> places, Index begin, Index end,
                                            Arrange arrange) {
  constexpr Index kAtOnce = 256;  // vertices that a thread takes together
  const Index chunks = chunk_count(end - begin, kAtOnce);
  if (index_size(findings_) < chunks) findings_.resize(static_cast<std::size_t>(chunks));
  const std::span<const Index> found_before = places.first(static_cast<std::size_t>(end));
  for_each_chunk(end - begin, kAtOnce, [&](Index chunk, Index from, Index to) {
    std::vector<Finding>& own = findings_[chunk];
    own.clear();
    for (Index k = begin + from; k < begin + to; ++k) {
      prefetch_row(graph_, found_before, k);
      for (const Index u : graph_[places[k]]) {
        const std::atomic_ref<Index> by(found_by_[u]);
        Index other = by.load(std::memory_order_relaxed);
        while (k < other && !by.compare_exchange_weak(other, k, std::memory_order_relaxed)) {
        }
        if (k < other) own.push_back({u, k});
      }
    }
  });
  for_each_chunk(chunks, 1, [&](Index chunk, Index, Index) {
    std::erase_if(findings_[chunk], [&](const Finding& one) { return found_by_[one.vertex] != one.by; });
  });
  std::vector<Index> first(static_cast<std::size_t>(chunks) + 1, end);
  for (Index c = 0; c < chunks; ++c) first[c + 1] = first[c] + index_size(findings_[c]);
  for_each_chunk(chunks, 1, [&](Index chunk, Index, Index) {
    const std::vector<Finding>& own = findings_[chunk];
    const std::span<Index> to = places.subspan(first[chunk], own.size());
    std::ranges::transform(own, to.begin(), &Finding::vertex);
    if (arrange == nullptr) return;
    for (std::size_t k = 0; k < own.size();) {
      const std::size_t begin_of_run = k;
      while (k < own.size() && own[k].by == own[begin_of_run].by) ++k;
      if (k - begin_of_run > 1) arrange(graph_, to.subspan(begin_of_run, k - begin_of_run));
    }
  });
  return first.back();
}

}  // namespace meshorder
