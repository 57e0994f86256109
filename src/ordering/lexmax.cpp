// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/buckets.hpp"
#include "base/parallel.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr Offset kInEntry = 4;  // number of ranks in an Entry
constexpr Index kPart = 65536;  // elements that a thread takes at a time

/// An element with the four largest ranks of its vertices in descending order; −1 for missing vertices. Most
/// comparisons need only these ranks, so they are side by side in memory.
struct Entry {
  std::array<Index, kInEntry> ranks;
  Index item;  ///< the element
};

}  // namespace

template <>
struct StoredEntry<Entry> {
  static_assert(kPart - 1 <= UINT16_MAX);
  std::array<Index, kInEntry - 1> other_ranks;
  std::uint16_t largest_rank;  ///< relative to the first rank of its bucket
  std::uint16_t item;          ///< relative to the first element of its part

  static StoredEntry of(const Entry& entry, Index first_item, Index first_rank) {
    const auto& [largest, second, third, fourth] = entry.ranks;
    return {{second, third, fourth},
            static_cast<std::uint16_t>(largest - first_rank),
            static_cast<std::uint16_t>(entry.item - first_item)};
  }
  [[nodiscard]] Entry whole(Index first_item, Index first_rank) const {
    const auto& [second, third, fourth] = other_ranks;
    return {{first_rank + largest_rank, second, third, fourth}, first_item + item};
  }
};

namespace {

Entry entry_of(Index element, std::span<const Index> vertices, std::span<const Index> rank_of) {
  Entry entry{{-1, -1, -1, -1}, element};
  for (const Index v : vertices) {
    Index rank = rank_of[v];
    for (Index& larger : entry.ranks) {
      const Index smaller = std::min(larger, rank);
      larger = std::max(larger, rank);
      rank = smaller;
    }
  }
  return entry;
}

/// Returns the ranks of every element's vertices, in descending order within each element; empty if every
/// Entry holds all ranks of its element.
std::vector<Index> falling_ranks(IncidenceRef elements, std::span<const Index> rank_of) {
  Offset most = 0;
  for (Index e = 0; e < elements.size(); ++e) most = std::max<Offset>(most, std::ssize(elements[e]));
  if (most <= kInEntry) return {};
  std::vector<Index> ranks(elements.vertices.size());
  for_each_chunk(elements.size(), kPart, [&](Index /*chunk*/, Index begin, Index end) {
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
  const auto largest_rank = [](const Entry& entry) { return entry.ranks[0]; };
  const auto entries_of = [&](Index /*part*/, Index begin, Index end) {
    std::vector<Entry> entries;
    entries.reserve(std::size_t(end - begin));
    for (Index e = begin; e < end; ++e) entries.push_back(entry_of(e, elements[e], rank_of));
    return [entries = std::move(entries)](const auto& call) { std::ranges::for_each(entries, call); };
  };
  const Buckets<Entry> buckets(elements.size(), kPart, elements.vertex_count, entries_of, largest_rank);

  const std::vector<Index> all_ranks = falling_ranks(elements, rank_of);
  // compares the ranks after the largest, then the numbers of the elements, so that no two entries are equal
  const auto before = [&](const Entry& a, const Entry& b) {
    for (std::size_t k = 1; k < kInEntry; ++k) {
      if (a.ranks[k] != b.ranks[k]) return a.ranks[k] < b.ranks[k];
    }
    const auto rest = [&](const Entry& entry) -> std::span<const Index> {
      if (all_ranks.empty()) return {};
      const Offset end = elements.offsets[entry.item + 1];
      return {all_ranks.data() + std::min(elements.offsets[entry.item] + kInEntry, end),
              all_ranks.data() + end};
    };
    const auto order = std::lexicographical_compare_three_way(rest(a).begin(), rest(a).end(), rest(b).begin(),
                                                              rest(b).end());
    return order < 0 || (order == 0 && a.item < b.item);
  };
  const auto sort = [&](std::span<Entry> entries) { std::ranges::sort(entries, before); };
  return {Permutation::from_new_to_old(sorted_items(buckets, largest_rank, sort)), {}};
}

}  // namespace meshorder
