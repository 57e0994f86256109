// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "ordering/all_methods.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <compare>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kElementsTogether = 65536;  // elements or vertices that a thread takes together

/// An element with the ranks of its vertices after the largest, falling, −1 where there are none: what most
/// comparisons need, side by side in memory.
struct Entry {
  std::array<Index, 3> next;
  Index element;
};

Index largest_rank(std::span<const Index> vertices, std::span<const Index> rank_of) {
  Index largest = -1;
  for (const Index v : vertices) largest = std::max(largest, rank_of[v]);
  return largest;
}

Entry entry_of(Index element, std::span<const Index> vertices, std::span<const Index> rank_of) {
  std::array<Index, 4> falling{-1, -1, -1, -1};
  for (const Index v : vertices) {
    Index rank = rank_of[v];
    for (Index& larger : falling) {
      const Index smaller = std::min(larger, rank);
      larger = std::max(larger, rank);
      rank = smaller;
    }
  }
  return {{falling[1], falling[2], falling[3]}, element};
}

/// The ranks of every element's vertices, falling within each element; none where an Entry has them all.
std::vector<Index> falling_ranks(IncidenceRef elements, std::span<const Index> rank_of) {
  constexpr Offset kInEntry = 4;
  Offset most = 0;
  for (Index e = 0; e < elements.size(); ++e) most = std::max(most, std::ssize(elements[e]));
  if (most <= kInEntry) return {};
  std::vector<Index> ranks(elements.vertices.size());
  for_each_chunk(elements.size(), kElementsTogether, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index e = begin; e < end; ++e) {
      const auto own = ranks.begin() + elements.offsets[e];
      std::transform(elements[e].begin(), elements[e].end(), own, [&](Index v) { return rank_of[v]; });
      std::sort(own, ranks.begin() + elements.offsets[e + 1], std::greater<>());
    }
  });
  return ranks;
}

}  // namespace

Order lexmax_elements(const ElementInput& input, const OrderOptions&) {
  const IncidenceRef elements = input.elements;
  const std::span<const Index> rank_of = input.vertices.old_to_new();
  const auto largest = [&](Index e) { return largest_rank(elements[e], rank_of); };

  // a bucket for each largest rank, filled in any order
  std::vector<Index> bucket(Offset{elements.vertex_count} + 1, 0);
  for_each_chunk(elements.size(), kElementsTogether, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index e = begin; e < end; ++e)
      std::atomic_ref(bucket[largest(e) + 1]).fetch_add(1, std::memory_order_relaxed);
  });
  std::partial_sum(bucket.begin(), bucket.end(), bucket.begin());
  std::vector<Index> next(bucket.begin(), bucket.end() - 1);
  std::vector<Entry> entries(elements.size());
  for_each_chunk(elements.size(), kElementsTogether, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index e = begin; e < end; ++e) {
      const Index place = std::atomic_ref(next[largest(e)]).fetch_add(1, std::memory_order_relaxed);
      entries[place] = entry_of(e, elements[e], rank_of);
    }
  });

  const std::vector<Index> ranks = falling_ranks(elements, rank_of);
  // the few elements of each bucket by the rest of their ranks, ties by number: an order without equals, in
  // which the order that the bucket was filled in is lost
  const auto before = [&](const Entry& a, const Entry& b) {
    if (a.next != b.next) return a.next < b.next;
    const auto rest = [&](const Entry& entry) -> std::span<const Index> {
      if (ranks.empty()) return {};
      const Offset end = elements.offsets[entry.element + 1];
      return {ranks.data() + std::min(elements.offsets[entry.element] + 4, end), ranks.data() + end};
    };
    const auto order = std::lexicographical_compare_three_way(rest(a).begin(), rest(a).end(), rest(b).begin(),
                                                              rest(b).end());
    return order < 0 || (order == 0 && a.element < b.element);
  };
  std::vector<Index> new_to_old(elements.size());
  for_each_chunk(elements.vertex_count, kElementsTogether, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index v = begin; v < end; ++v)
      std::sort(entries.begin() + bucket[v], entries.begin() + bucket[v + 1], before);
    for (Index place = bucket[begin]; place < bucket[end]; ++place)
      new_to_old[place] = entries[place].element;
  });
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace meshorder
