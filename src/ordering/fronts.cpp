// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/fronts.hpp"

#include "base/parallel.hpp"
#include "graph/row_access.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kChunk = 2048;  // vertices: fewer cost springs 2 %, four times as many cost products 3 %
constexpr Index kSection = 32 * kChunk;  // vertices that one thread takes

/// Renumbers the chunks of a section one after the other. Loops over neighbours write without a branch, which
/// would be unpredictable.
class Section {
 public:
  /// @param places  of each place in the order the new one, where it is known
  Section(GraphRef graph, const Permutation& order, Index begin, std::span<Index> places)
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
    Index first = 0;  // that may not have been reached
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
  /// Finds the neighbours of the chunk's vertices among themselves, and of each the earliest before the
  /// chunk.
  void find_neighbours(Index begin, Index end) {
    const std::span<const Index> vertices = order_.new_to_old();
    const std::span<const Index> place_of = order_.old_to_new();
    std::size_t pairs = 0;
    seeds_.clear();
    for (Index place = begin; place < end; ++place) {
      prefetch_ahead(place);
      const std::span<const Index> row = graph_[vertices[place]];
      if (pairs_.size() < pairs + row.size()) pairs_.resize(2 * (pairs + row.size()));
      if (earlier_.size() < row.size()) earlier_.resize(row.size());
      std::size_t earlier = 0;
      for (const Index u : row) {
        const Index there = place_of[u];
        pairs_[pairs] = {there - begin, place - begin};
        pairs += there >= begin && there < end ? 1 : 0;
        earlier_[earlier] = there;
        earlier += there < begin ? 1 : 0;
      }
      if (earlier == 0) continue;
      Index earliest = begin;
      for (std::size_t k = 0; k < earlier; ++k) earliest = std::min(earliest, number_at(earlier_[k]));
      seeds_.emplace_back(earliest, place - begin);
    }
    // each row gets its entries as they come, which is in the order of their places
    const std::span found = std::span(pairs_).first(pairs);
    starts_.fill(0);
    for (const auto& [row, entry] : found) ++starts_[row + 2];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    neighbours_.resize(std::max(neighbours_.size(), pairs));
    for (const auto& [row, entry] : found) neighbours_[starts_[row + 1]++] = entry;
  }

  /// Asks for what the rows of the next places need: where they begin, their entries, and these's places.
  void prefetch_ahead(Index place) const {
    constexpr Index kAhead = 6;
    const std::span<const Index> vertices = order_.new_to_old();
    if (place + 3 * kAhead >= index_size(vertices)) return;
    __builtin_prefetch(graph_.offsets.data() + vertices[place + 3 * kAhead]);
    const Offset* const row = graph_.offsets.data() + vertices[place + 2 * kAhead];
    __builtin_prefetch(graph_.neighbours.data() + row[0]);
    __builtin_prefetch(graph_.neighbours.data() + row[1] - 1);
    for (const Index u : graph_[vertices[place + kAhead]]) __builtin_prefetch(order_.old_to_new().data() + u);
  }

  /// Returns the new number of a place before the chunk; of one before the section, which another thread
  /// may renumber now, the place itself, which is less than a chunk away.
  [[nodiscard]] Index number_at(Index place) const { return place < begin_ ? place : places_[place]; }

  GraphRef graph_;
  const Permutation& order_;
  Index begin_;
  std::span<Index> places_;
  std::vector<std::pair<Index, Index>> pairs_;  ///< neighbours in the chunk
  std::vector<Index> earlier_;                  ///< neighbours of one vertex before the chunk
  std::vector<std::pair<Index, Index>> seeds_;  ///< earliest neighbour before the chunk, vertex
  std::array<Index, kChunk + 2> starts_;        ///< of each vertex of the chunk in `neighbours_`
  std::vector<Index> neighbours_;
  std::array<Index, kChunk + 1> queue_;
  std::array<char, kChunk> is_queued_;
};

}  // namespace

Permutation in_fronts(GraphRef graph, const Permutation& order) {
  std::vector<Index> places(order.new_to_old().size());
  std::vector<Index> new_to_old(places.size());
  for_each_chunk(order.size(), kSection, [&](Index /*section*/, Index begin, Index end) {
    Section section(graph, order, begin, places);
    for (Index next = begin; next < end;) {
      const Index chunk = std::exchange(next, next + std::min(kChunk, end - next));
      section.renumber_chunk(chunk, next);
    }
    for (Index place = begin; place < end; ++place) new_to_old[places[place]] = order.new_to_old()[place];
  });
  return Permutation::from_new_to_old(std::move(new_to_old));
}

}  // namespace meshorder
