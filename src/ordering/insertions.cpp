// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "ordering/arrangement_graph.hpp"

#include <algorithm>
#include <atomic>

namespace meshorder {
namespace {

constexpr Index kChunk = 4096;
constexpr Index kReach = 64;  // places that a slide may pass for each edge of the vertex
constexpr Offset kSlack = 2;  // allowance of a slide / (weight of the vertex's edges · its volume)

/// The places begin … end−1 of the line.
struct Places {
  Index begin;
  Index end;
};

/// The state of the search. Each thread touches only the vertices of its own chunk. `chunk_of_` gives the
/// chunk of a vertex without reading its place, which another thread may be writing.
class InsertionSearch {
 public:
  InsertionSearch(const ArrangementGraph& graph, std::vector<Index>& order)
      : graph_(graph),
        order_(order),
        place_(graph.size()),
        volume_at_(graph.size()),
        balance_at_(graph.size(), 0),
        weight_at_(graph.size(), 0),
        chunk_of_(graph.size()) {
    for (Index k = 0; k < graph.size(); ++k) place_[order[k]] = k;
    for (Index k = 0; k < graph.size(); ++k) {
      poll_in_loop(k);
      const Index v = order[k];
      volume_at_[k] = graph.volumes[v];
      for (Offset e = graph.offsets[v]; e < graph.offsets[v + 1]; ++e) {
        balance_at_[k] += place_[graph.neighbours[e]] > k ? graph.weight(e) : -graph.weight(e);
      }
    }
  }

  /// Takes every vertex out and puts it back, chunk by chunk; the first chunk is shorter by `shift`. Returns
  /// whether a vertex moved.
  bool pass(Index shift) {
    const Index n = graph_.size();
    for (Index k = 0; k < n; ++k) chunk_of_[order_[k]] = (k + shift) / kChunk;
    std::atomic<bool> moved = false;
    for_each_chunk(n + shift, kChunk, [&](Index chunk, Index begin, Index end) {
      const Places places{std::max(begin - shift, 0), end - shift};
      const std::vector<Index> vertices(order_.begin() + places.begin, order_.begin() + places.end);
      bool moved_here = false;
      for (const Index v : vertices) moved_here |= reinsert(v, chunk, places);
      if (moved_here) moved = true;
    });
    return moved;
  }

  [[nodiscard]] Offset total_span() const {
    // the span of an edge is its weight times the difference of the later and the earlier middle
    Offset sum = 0;
    Offset begin = 0;
    for (Index k = 0; k < graph_.size(); ++k) {
      sum -= balance_at_[k] * (begin + volume_at_[k]);
      begin += 2 * Offset{volume_at_[k]};
    }
    return sum;
  }

 private:
  struct Slide {
    Index place;        ///< the best place of the slide
    Offset change = 0;  ///< change of the total span at that place
  };

  /// Returns the best place on one side of `from`: later places for a `step` of 1, earlier places for −1.
  /// `weight_at_` has the weights of the vertex's edges.
  [[nodiscard]] Slide slide(Index from, Index step, Index last, Offset allowance) const {
    Slide best{from};
    const Offset volume = volume_at_[from];
    Offset ahead = step * balance_at_[from];  // weight of the edges ahead minus weight of the other edges
    Offset change = 0;
    for (Index k = from + step; k != last + step; k += step) {
      const Offset weight = weight_at_[k];
      change += volume_at_[k] * (weight - ahead) + volume * (weight + step * balance_at_[k]);
      ahead -= 2 * weight;
      if (change < best.change) best = {k, change};
      if (change > best.change + allowance) break;
    }
    return best;
  }

  /// Puts v at the place within reach where the total span is least. Returns whether v moved.
  bool reinsert(Index v, Index chunk, const Places& places) {
    const Index from = place_[v];
    Offset degree = 0;
    for (Offset e = graph_.offsets[v]; e < graph_.offsets[v + 1]; ++e) {
      const Index u = graph_.neighbours[e];
      if (chunk_of_[u] == chunk) weight_at_[place_[u]] = graph_.weight(e);
      degree += graph_.weight(e);
    }
    const Offset allowance = kSlack * degree * volume_at_[from];
    const Offset reach = kReach * (graph_.offsets[v + 1] - graph_.offsets[v]);
    const auto last = static_cast<Index>(std::min(Offset{places.end} - 1, from + reach));
    const auto first = static_cast<Index>(std::max(Offset{places.begin}, from - reach));
    const Slide up = slide(from, 1, last, allowance);
    const Slide down = slide(from, -1, first, allowance);
    for (Offset e = graph_.offsets[v]; e < graph_.offsets[v + 1]; ++e) {
      const Index u = graph_.neighbours[e];
      if (chunk_of_[u] == chunk) weight_at_[place_[u]] = 0;
    }
    const bool goes_up = up.change <= down.change;
    const Index to = goes_up ? up.place : down.place;
    if (to == from) return false;
    move(v, chunk, to, goes_up ? 1 : -1);
    return true;
  }

  /// Moves v to the place `to`, which lies in the direction of `step`; the vertices in between move by one
  /// place.
  void move(Index v, Index chunk, Index to, Index step) {
    const Index from = place_[v];
    const Index volume = volume_at_[from];
    Offset balance = balance_at_[from];
    for (Offset e = graph_.offsets[v]; e < graph_.offsets[v + 1]; ++e) {
      const Index u = graph_.neighbours[e];
      if (chunk_of_[u] != chunk) continue;
      const Index k = place_[u];
      if ((k - from) * step <= 0 || (k - to) * step > 0) continue;
      balance_at_[k] += 2 * step * graph_.weight(e);
      balance -= 2 * step * graph_.weight(e);
    }
    for (Index k = from; k != to; k += step) {
      order_[k] = order_[k + step];
      volume_at_[k] = volume_at_[k + step];
      balance_at_[k] = balance_at_[k + step];
      place_[order_[k]] = k;
    }
    order_[to] = v;
    volume_at_[to] = volume;
    balance_at_[to] = balance;
    place_[v] = to;
  }

  const ArrangementGraph& graph_;
  std::vector<Index>& order_;
  std::vector<Index> place_;
  // indexed by place, because slides read successive places
  std::vector<Index> volume_at_;
  std::vector<Offset> balance_at_;  // weight of edges to later vertices minus that to earlier ones
  std::vector<Offset> weight_at_;   // weight of the edge to the vertex being moved
  std::vector<Index> chunk_of_;     // the chunk of each vertex
};

}  // namespace

Offset improve_by_insertions(const ArrangementGraph& graph, std::vector<Index>& order, int passes) {
  InsertionSearch search(graph, order);
  for (int pass = 0; pass < passes; ++pass) {
    if (!search.pass(pass % 2 == 0 ? 0 : kChunk / 2)) break;
  }
  return search.total_span();
}

}  // namespace meshorder
