// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/carried.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kUnranked = -1;

/// The place of a new vertex: after the old vertex whose rank is `after`. New vertices with the same place
/// keep the order in which they were found.
struct Insertion {
  Index after;
  Index vertex;
};

/// Returns the vertices that have a place, in the order of their places.
std::vector<Index> survivors(std::span<const Index> places, Index count) {
  std::vector<Index> at(static_cast<std::size_t>(count), kUnranked);
  for (std::size_t v = 0; v < places.size(); ++v) {
    if (places[v] != kUnranked) at[static_cast<std::size_t>(places[v])] = static_cast<Index>(v);
  }
  std::erase(at, kUnranked);
  return at;
}

/// Returns the median rank of the neighbours that have a rank; kUnranked if no neighbour has a rank.
Index median_rank(std::span<const Index> neighbours, std::span<const Index> rank_of,
                  std::vector<Index>& ranks) {
  ranks.clear();
  for (const Index u : neighbours) {
    if (rank_of[static_cast<std::size_t>(u)] != kUnranked)
      ranks.push_back(rank_of[static_cast<std::size_t>(u)]);
  }
  if (ranks.empty()) return kUnranked;
  const auto middle = ranks.begin() + static_cast<std::ptrdiff_t>((ranks.size() - 1) / 2);
  std::nth_element(ranks.begin(), middle, ranks.end());
  return *middle;
}

/// Finds ranks for the new vertices in waves: each wave ranks those that have neighbours with a rank.
///
/// @param rank_of  rank of each vertex, kUnranked for new vertices; receives the ranks that are found
std::vector<Insertion> found_places(std::span<const Index> added, const NeighbourRows& rows,
                                    std::vector<Index>& rank_of) {
  const auto row_of = [&](Index k) {
    const Offset begin = rows.offsets[static_cast<std::size_t>(k)];
    const Offset end = rows.offsets[static_cast<std::size_t>(k) + 1];
    return std::span(rows.neighbours.data() + begin, static_cast<std::size_t>(end - begin));
  };
  std::vector<Index> number_of(rank_of.size(), kUnranked);  // number among the new vertices
  std::vector<Index> wave(added.size());
  for (std::size_t k = 0; k < added.size(); ++k) {
    wave[k] = static_cast<Index>(k);
    number_of[static_cast<std::size_t>(added[k])] = wave[k];
  }
  std::vector<Insertion> found;
  found.reserve(added.size());
  std::vector<Index> ranks;
  while (!wave.empty()) {
    const std::size_t first = found.size();
    std::vector<Index> next;
    for (const Index k : wave) {
      const Index after = median_rank(row_of(k), rank_of, ranks);
      if (after == kUnranked) continue;
      found.push_back({after, added[static_cast<std::size_t>(k)]});
      for (const Index u : row_of(k)) next.push_back(number_of[static_cast<std::size_t>(u)]);
    }
    // new ranks are used only from the next wave on, so that the result does not depend on how vertices are
    // numbered
    for (std::size_t i = first; i < found.size(); ++i) {
      rank_of[static_cast<std::size_t>(found[i].vertex)] = found[i].after;
      number_of[static_cast<std::size_t>(found[i].vertex)] = kUnranked;
    }
    std::erase_if(next, [&](Index k) {
      return k == kUnranked ||
             number_of[static_cast<std::size_t>(added[static_cast<std::size_t>(k)])] == kUnranked;
    });
    std::ranges::sort(next);
    next.erase(std::unique(next.begin(), next.end()), next.end());
    wave = std::move(next);
  }
  return found;
}

}  // namespace

VertexChanges changes_of(const IndexView& previous, Index size, Index count) {
  VertexChanges changes;
  if (previous.empty()) {
    if (size == 0) changes.removed = count;
    if (size > 0 && count > 0 && size != count) {
      throw InvalidArgument("previous: it is missing; there are " + std::to_string(size) +
                            " vertices, and the last update had " + std::to_string(count));
    }
    return changes;
  }
  if (previous.size() != static_cast<std::size_t>(size)) {
    throw InvalidArgument("previous: " + std::to_string(previous.size()) + " entries for " +
                          std::to_string(size) + " vertices");
  }
  std::size_t same = 0;
  while (same < previous.size() && std::cmp_equal(previous[same], same)) ++same;
  if (same == previous.size() && size == count) return changes;
  changes.places.resize(previous.size());
  std::vector<Index> vertex_at(static_cast<std::size_t>(count), -1);
  for (std::size_t v = 0; v < previous.size(); ++v) {
    const std::int64_t place = previous[v];
    if (place < -1 || place >= count) {
      throw InvalidArgument("previous: entry " + std::to_string(v) + " is " + std::to_string(place) +
                            (count == 0 ? ", but there were no vertices before"
                                        : ", outside -1 … " + std::to_string(count - 1)));
    }
    changes.places[v] = static_cast<Index>(place);
    if (place < 0) {
      changes.added.push_back(static_cast<Index>(v));
    } else if (Index& other = vertex_at[static_cast<std::size_t>(place)]; other >= 0) {
      throw InvalidArgument("previous: entries " + std::to_string(other) + " and " + std::to_string(v) +
                            " are both " + std::to_string(place));
    } else {
      other = static_cast<Index>(v);
    }
  }
  changes.removed = count - (size - static_cast<Index>(changes.added.size()));
  return changes;
}

std::vector<Index> carried_order(std::span<const Index> places, Index count, std::span<const Index> added,
                                 const NeighbourRows& rows) {
  std::vector<Index> old = survivors(places, count);
  if (added.empty()) return old;
  std::vector<Index> rank_of(places.size(), kUnranked);
  for (std::size_t k = 0; k < old.size(); ++k)
    rank_of[static_cast<std::size_t>(old[k])] = static_cast<Index>(k);
  std::vector<Insertion> found = found_places(added, rows, rank_of);
  std::ranges::stable_sort(found, {}, &Insertion::after);
  std::vector<Index> order;
  order.reserve(places.size());
  std::size_t next = 0;
  for (std::size_t k = 0; k < old.size(); ++k) {
    order.push_back(old[k]);
    for (; next < found.size() && static_cast<std::size_t>(found[next].after) == k; ++next)
      order.push_back(found[next].vertex);
  }
  for (const Index v : added) {
    if (rank_of[static_cast<std::size_t>(v)] == kUnranked) order.push_back(v);
  }
  return order;
}

}  // namespace meshorder
