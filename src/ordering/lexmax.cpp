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

/// The ranks of every element's vertices, falling within each element.
std::vector<Index> falling_ranks(const ElementInput& input) {
  const IncidenceRef elements = input.elements;
  std::vector<Index> ranks(elements.vertices.size());
  for_each_chunk(elements.size(), kElementsTogether, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index e = begin; e < end; ++e) {
      const auto own = ranks.begin() + elements.offsets[e];
      std::transform(elements[e].begin(), elements[e].end(), own,
                     [&](Index v) { return input.vertices.old_to_new()[v]; });
      std::sort(own, ranks.begin() + elements.offsets[e + 1], std::greater<>());
    }
  });
  return ranks;
}

/// An element with the ranks after its largest, −1 where there are none: what most comparisons need, side by
/// side in memory.
struct Entry {
  std::array<Index, 3> next;
  Index element;
};

Entry entry_of(IncidenceRef elements, const std::vector<Index>& ranks, Index e) {
  Entry entry{{-1, -1, -1}, e};
  const Offset begin = elements.offsets[e] + 1;
  const Offset count = std::min<Offset>(3, elements.offsets[e + 1] - begin);
  std::copy_n(ranks.begin() + begin, count, entry.next.begin());
  return entry;
}

}  // namespace

Order lexmax_elements(const ElementInput& input, const OrderOptions&) {
  const IncidenceRef elements = input.elements;
  const std::vector<Index> ranks = falling_ranks(input);
  const auto largest = [&](Index e) { return ranks[elements.offsets[e]]; };

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
      entries[place] = entry_of(elements, ranks, e);
    }
  });

  // the few elements of each bucket by the rest of their ranks, ties by number: an order without equals, in
  // which the order that the bucket was filled in is lost
  const auto before = [&](const Entry& a, const Entry& b) {
    if (a.next != b.next) return a.next < b.next;
    const auto rest = [&](const Entry& entry) {
      const Offset end = elements.offsets[entry.element + 1];
      return std::span(ranks.data() + std::min(elements.offsets[entry.element] + 4, end), ranks.data() + end);
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
