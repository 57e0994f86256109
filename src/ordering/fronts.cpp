// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "graph/row_access.hpp"
#include "ordering/all_methods.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kInChunk = 2048;  // vertices: with fewer, springs take 2 % longer; with four times as many,
                                  // products take 3 % longer
constexpr Index kInSection = 32 * kInChunk;  // vertices that a thread takes at a time
constexpr Index kAheadOfOffset = 24;
constexpr Index kAheadOfRow = 8;
constexpr Index kAheadOfPlaces = 4;

/// Renumbers the chunks of a section one after the other. Loops over neighbours write without branches, which
/// would be unpredictable.
class SectionRenumbering {
 public:
  /// @param places  the new place for each place in the old order; set chunk by chunk
  SectionRenumbering(GraphRef graph, const Permutation& order, Index begin, std::span<Index> places)
      : graph_(graph), order_(order), begin_(begin), places_(places) {}

  void renumber_chunk(Index begin, Index end) {
    find_neighbours(begin, end);
    std::ranges::sort(seeds_);
    is_queued_.fill(0);
    Index queued = 0;
    const auto enqueue = [&](Index vertex) {
      queue_[queued] = vertex;
      queued += is_queued_[vertex] == 0 ? 1 : 0;
      is_queued_[vertex] = 1;
    };
    for (const auto& [earliest, vertex] : seeds_) enqueue(vertex);
    Index first = 0;  // all vertices before this one are in the queue
    for (Index next = 0; next < end - begin;) {
      if (next == queued) {
        enqueue(first++);
        continue;
      }
      const Index v = queue_[next];
      places_[begin + v] = begin + next++;
      for (Index k = starts_[v]; k < starts_[v + 1]; ++k) enqueue(neighbours_[k]);
    }
  }

 private:
  /// Finds the edges within the chunk, and for each of its vertices the earliest neighbour before the
  /// chunk.
  void find_neighbours(Index begin, Index end) {
    const std::span<const Index> vertices = order_.new_to_old();
    const std::span<const Index> place_of = order_.old_to_new();
    Index found = 0;
    seeds_.clear();
    for (Index place = begin; place < end; ++place) {
      // prefetches for later places; not in a function, whose calls GCC 12 drops as code without effect
      if (place + kAheadOfOffset < index_size(vertices)) {
        prefetch_offsets(graph_.offsets, vertices.subspan(place + kAheadOfOffset, 1));
        prefetch_rows(graph_.offsets, graph_.neighbours, vertices.subspan(place + kAheadOfRow, 1));
        for (const Index u : graph_[vertices[place + kAheadOfPlaces]])
          __builtin_prefetch(place_of.data() + u);
      }
      const std::span<const Index> row = graph_[vertices[place]];
      if (neighbours_.size() < found + row.size()) neighbours_.resize(2 * (found + row.size()));
      if (earlier_.size() < row.size()) earlier_.resize(row.size());
      Index earlier = 0;
      starts_[place - begin] = found;
      for (const Index u : row) {
        const Index there = place_of[u];
        neighbours_[found] = there - begin;
        found += there >= begin && there < end ? 1 : 0;
        earlier_[earlier] = there;
        earlier += there < begin ? 1 : 0;
      }
      if (earlier == 0) continue;
      Index earliest = begin;
      for (Index k = 0; k < earlier; ++k) earliest = std::min(earliest, number_at(earlier_[k]));
      seeds_.emplace_back(earliest, place - begin);
    }
    starts_[end - begin] = found;
  }

  /// Returns the new number of a place before the chunk. Another thread may be renumbering places before the
  /// section: for such places, returns the old place, which is less than a chunk away from the new one.
  [[nodiscard]] Index number_at(Index place) const { return place < begin_ ? place : places_[place]; }

  GraphRef graph_;
  const Permutation& order_;
  Index begin_;
  std::span<Index> places_;
  std::vector<Index> earlier_;                  ///< old places of a vertex's neighbours before the chunk
  std::vector<std::pair<Index, Index>> seeds_;  ///< earliest neighbour before the chunk, vertex
  std::array<Index, kInChunk + 1> starts_;      ///< where each vertex's row begins in `neighbours_`
  std::vector<Index> neighbours_;
  std::array<Index, kInChunk + 1> queue_;
  std::array<char, kInChunk> is_queued_;
};

}  // namespace

Permutation in_fronts(GraphRef graph, const Permutation& order) {
  std::vector<Index> places(order.new_to_old().size());
  std::vector<Index> new_to_old(places.size());
  for_each_chunk(order.size(), kInSection, [&](Index /*section*/, Index begin, Index end) {
    SectionRenumbering section(graph, order, begin, places);
    for (Index next = begin; next < end;) {
      const Index chunk = std::exchange(next, next + std::min(kInChunk, end - next));
      section.renumber_chunk(chunk, next);
    }
    for (Index place = begin; place < end; ++place) new_to_old[places[place]] = order.new_to_old()[place];
  });
  return Permutation::from_new_to_old(std::move(new_to_old));
}

}  // namespace meshorder
