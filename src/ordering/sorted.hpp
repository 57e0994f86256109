// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/buckets.hpp"
#include "base/parallel.hpp"
#include <meshorder/permutation.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {

/// Sorts values that are all different. Ranges of the values are sorted and then merged on all threads, with
/// a poll between ranges. O(n log n) time; memory for a copy of the values.
template <class T>
void sort_distinct(std::vector<T>& values) {
  constexpr Index kRun = 65536;
  const Index n = index_size(values);
  for_each_chunk(n, kRun, [&](Index /*chunk*/, Index begin, Index end) {
    std::sort(values.begin() + begin, values.begin() + end);
  });
  std::vector<T> merged(n > kRun ? values.size() : 0);
  for (Offset run = kRun; run < n; run *= 2) {
    const auto at = [&](Offset place) { return values.begin() + std::min<Offset>(place, n); };
    parallel_loop(static_cast<Index>((n + 2 * run - 1) / (2 * run)), [&](Index pair) {
      const Offset begin = 2 * run * pair;
      std::merge(at(begin), at(begin + run), at(begin + run), at(begin + 2 * run), merged.begin() + begin);
    });
    values.swap(merged);
  }
}

/// Returns the items of all entries, bucket after bucket, by ascending key. Runs on all threads. O(entries)
/// time, plus that of the sorts.
///
/// @param key   the same as for the buckets
/// @param sort  `sort(entries)` sorts the entries of one key, a `std::span<Entry>` of two or more
template <class Entry, class Key, class Sort>
std::vector<Index> sorted_items(const Buckets<Entry>& buckets, const Key& key, const Sort& sort) {
  std::vector<Index> items(std::size_t(buckets.start(buckets.size())));
  parallel_loop(buckets.size(), [&](Index bucket) {
    const std::vector<Offset> starts = buckets.key_starts(bucket, key);
    std::vector<Offset> next = starts;
    std::vector<Entry> entries(std::size_t(starts.back() - starts.front()));
    buckets.for_each(bucket, [&](const Entry& entry) {
      entries[next[key(entry) - buckets.first_key(bucket)]++ - starts.front()] = entry;
    });
    for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
      if (starts[k + 1] - starts[k] < 2) continue;
      sort(std::span(entries).subspan(starts[k] - starts.front(), starts[k + 1] - starts[k]));
    }
    std::ranges::transform(entries, items.begin() + starts.front(), &Entry::item);
  });
  return items;
}

/// A number 0 … n−1 and the value that it is sorted by.
template <class Value>
struct ValuedItem {
  Value value;
  Index item;

  bool operator<(const ValuedItem& other) const {
    return value < other.value || (value == other.value && item < other.item);
  }
};

/// Sorts by value, ties by number.
struct SortByValue {
  template <class Value>
  void operator()(std::span<ValuedItem<Value>> entries) const {
    std::sort(entries.begin(), entries.end());
  }
};

/// Returns the numbers 0 … n−1 sorted by the places of their values, and within a place by `sort`. Runs on
/// all threads; computes each value once. O(n log n) at worst, O(n) if values are evenly spread over the
/// places.
///
/// @param places    number of places for values
/// @param place_of  `place_of(value)` returns the place of a value, 0 … places − 1; a larger value must not
///                  have a smaller place
/// @param sort      `sort(entries)` sorts the entries of one place, a `std::span<ValuedItem>` of two or more
template <class ValueOf, class PlaceOf, class Sort = SortByValue>
Permutation sorted_by(Index n, const ValueOf& value_of, Index places, const PlaceOf& place_of,
                      const Sort& sort = {}) {
  constexpr Index kPart = 65536;  // numbers that a thread takes at a time
  using Entry = ValuedItem<decltype(value_of(n))>;
  const auto place = [&](const Entry& entry) { return place_of(entry.value); };
  const auto entries_of = [&](Index /*part*/, Index begin, Index end) {
    std::vector<Entry> entries(std::size_t(end - begin));
    for (Index i = begin; i < end; ++i) entries[i - begin] = {value_of(i), i};
    return [entries = std::move(entries)](const auto& call) { std::ranges::for_each(entries, call); };
  };
  return Permutation::from_new_to_old(
      sorted_items(Buckets<Entry>(n, kPart, places, entries_of, place), place, sort));
}

}  // namespace meshorder
