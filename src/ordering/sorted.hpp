// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/permutation.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {

/// The numbers 0 … n−1 by rising key, ties by number. O(n log n).
template <class Key>
Permutation sorted_by(std::span<const Key> keys) {
  // sorting the pairs keeps each comparison within two neighbouring memory places
  std::vector<std::pair<Key, Index>> pairs(keys.size());
  for (Index i = 0; i < index_size(keys); ++i) pairs[i] = {keys[i], i};
  tbb::parallel_sort(pairs.begin(), pairs.end());  // no two are equal
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
