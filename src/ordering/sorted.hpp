// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"
#include <meshorder/permutation.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {

/// Sorts values of which no two are equal. Runs are sorted and merged on all threads, with a poll between
/// them. O(n log n) time, a copy of the values.
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

/// The numbers 0 … n−1 by rising key, ties by number. O(n log n).
template <class Key>
Permutation sorted_by(std::span<const Key> keys) {
  // sorting the pairs keeps each comparison within two neighbouring memory places
  std::vector<std::pair<Key, Index>> pairs(keys.size());
  for (Index i = 0; i < index_size(keys); ++i) pairs[i] = {keys[i], i};
  sort_distinct(pairs);
  std::vector<Index> new_to_old(keys.size());
  std::transform(pairs.begin(), pairs.end(), new_to_old.begin(),
                 [](const auto& pair) { return pair.second; });
  return Permutation::from_new_to_old(std::move(new_to_old));
}

template <class Key>
Permutation sorted_by(const std::vector<Key>& keys) {
  return sorted_by(std::span<const Key>(keys));
}

}  // namespace meshorder
