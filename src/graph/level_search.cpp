// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/level_search.hpp"

#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "graph/row_access.hpp"

#include <algorithm>
#include <atomic>

namespace meshorder {

LevelSearch::LevelSearch(GraphRef graph) : graph_(graph) {
  reserve_large(place_of_, static_cast<std::size_t>(graph.size()));
  place_of_.resize(graph.size(), kNotFound);
}

Index LevelSearch::run(Index start, std::span<Index> places, Arrange arrange, Index first) {
  constexpr Index kToShare = 2048;  // least size of a level for which other threads are started
  level_start_.clear();
  places[first] = start;
  place_of_[start] = first;
  Index found = first + 1;
  for (Index begin = first; begin < found;) {
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
  constexpr Offset kAtOnce = 1 << 18;
  for_each_range(end - first, kAtOnce, [&](Offset from, Offset to) {
    std::fill(place_of_.begin() + first + from, place_of_.begin() + first + to, kNotFound);
  });
}

Index LevelSearch::find_next_level(std::span<Index> places, Index begin, Index end, Arrange arrange) {
  Index found = end;
  for (Index k = begin; k < end; ++k) {
    poll_in_loop(k);
    prefetch_row(graph_, places.first(static_cast<std::size_t>(found)), k, place_of_.data());
    const Index first = found;
    for_each_below(graph_[places[k]], place_of_, 0, [&](Index u) {
      place_of_[u] = found;
      places[found++] = u;
    });
    if (arrange != nullptr && found - first > 1) arrange_found(places, first, found, arrange);
  }
  return found;
}

void LevelSearch::arrange_found(std::span<Index> places, Index first, Index end, Arrange arrange) {
  arrange(graph_, places.subspan(first, end - first));
  for (Index k = first; k < end; ++k) place_of_[places[k]] = k;
}

/// While threads read the rows of a level, `place_of_` holds a negative mark for each vertex that they find;
/// earlier rows give larger marks. If two threads mark a vertex at once, the mark stored last stays, and both
/// threads list the vertex. The second loop restores the largest mark; the third drops the other findings. An
/// atomic exchange would make the processor wait for one vertex at a time.
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
      prefetch_row(graph_, found_before, k, place_of_.data());
      const Index mark = begin - k - 1;
      for_each_below(graph_[places[k]], place_of_, mark, [&](Index u) {
        std::atomic_ref(place_of_[u]).store(mark, std::memory_order_relaxed);
        own.push_back({u, mark});
      });
    }
  });
  for_each_chunk(chunks, 1, [&](Index chunk, Index, Index) {
    for (const Finding& one : findings_[chunk]) {
      const std::atomic_ref<Index> place(place_of_[one.vertex]);
      Index other = place.load(std::memory_order_relaxed);
      while (other < one.mark && !place.compare_exchange_weak(other, one.mark, std::memory_order_relaxed)) {
      }
    }
  });
  for_each_chunk(chunks, 1, [&](Index chunk, Index, Index) {
    std::erase_if(findings_[chunk], [&](const Finding& one) { return place_of_[one.vertex] != one.mark; });
  });
  std::vector<Index> first(static_cast<std::size_t>(chunks) + 1, end);
  for (Index c = 0; c < chunks; ++c) first[c + 1] = first[c] + index_size(findings_[c]);
  for_each_chunk(chunks, 1, [&](Index chunk, Index, Index) {
    const std::vector<Finding>& own = findings_[chunk];
    for (Index k = 0; k < index_size(own); ++k) {
      places[first[chunk] + k] = own[k].vertex;
      place_of_[own[k].vertex] = first[chunk] + k;
    }
    if (arrange == nullptr) return;
    for (Index k = 0; k < index_size(own);) {
      const Index begin_of_run = k;
      while (k < index_size(own) && own[k].mark == own[begin_of_run].mark) ++k;
      if (k - begin_of_run > 1) arrange_found(places, first[chunk] + begin_of_run, first[chunk] + k, arrange);
    }
  });
  return first.back();
}

}  // namespace meshorder
