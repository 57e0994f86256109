// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/permutation.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"

#include <atomic>
#include <numeric>
#include <string>

namespace meshorder {
namespace {

constexpr Index kChunk = 65536;  // entries that a thread inverts together

/// Throws, naming the first entry that keeps `map` from being a bijection of 0 … n−1.
[[noreturn]] void fail(const std::vector<Index>& map) {
  const Index n = index_size(map);
  std::vector<Index> inverse(map.size(), -1);
  for (Index i = 0; i < n; ++i) {
    const Index target = map[i];
    if (target < 0 || target >= n) {
      throw InvalidArgument("permutation: entry " + std::to_string(i) + " is " + std::to_string(target) +
                            ", outside 0 … " + std::to_string(n - 1));
    }
    Index& source = inverse[target];
    if (source >= 0) {
      throw InvalidArgument("permutation: entries " + std::to_string(source) + " and " + std::to_string(i) +
                            " are both " + std::to_string(target));
    }
    source = i;
  }
  throw InvalidArgument("permutation: no bijection");
}

/// The inverse of `map`, which is checked to be a bijection of 0 … n−1.
std::vector<Index> inverted(const std::vector<Index>& map) {
  if (map.size() > static_cast<std::size_t>(kMaxIndex)) {
    throw InvalidArgument("permutation: more than 2,147,483,647 entries");
  }
  const Index n = index_size(map);
  std::vector<Index> inverse(map.size(), -1);
  std::atomic<bool> bijection = true;
  for_each_chunk(n, kChunk, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Index target = map[i];
      const bool first = target >= 0 && target < n &&
                         std::atomic_ref(inverse[target]).exchange(i, std::memory_order_relaxed) < 0;
      if (!first) bijection = false;
    }
  });
  if (!bijection) fail(map);
  return inverse;
}

}  // namespace

Permutation Permutation::identity(Index n) {
  std::vector<Index> map(static_cast<std::size_t>(n));
  std::iota(map.begin(), map.end(), Index{0});
  return {map, map};
}

Permutation Permutation::from_old_to_new(std::vector<Index> map) {
  std::vector<Index> inverse = inverted(map);
  return {std::move(map), std::move(inverse)};
}

Permutation Permutation::from_new_to_old(std::vector<Index> map) {
  std::vector<Index> inverse = inverted(map);
  return {std::move(inverse), std::move(map)};
}

bool Permutation::is_identity() const noexcept {
  for (Index i = 0; i < size(); ++i) {
    if (old_to_new_[i] != i) return false;
  }
  return true;
}

Permutation Permutation::inverse() const { return {new_to_old_, old_to_new_}; }

Permutation Permutation::then(const Permutation& next) const {
  if (next.size() != size()) {
    throw InvalidArgument("permutation: cannot chain " + std::to_string(size()) + " entries with " +
                          std::to_string(next.size()));
  }
  std::vector<Index> map(old_to_new_.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    map[i] = next.old_to_new_[static_cast<std::size_t>(old_to_new_[i])];
  }
  return from_old_to_new(std::move(map));
}

void Permutation::check_size(std::size_t values, std::size_t width) const {
  if (values != old_to_new_.size() * width) {
    throw InvalidArgument("permutation: " + std::to_string(values) + " values for " +
                          std::to_string(old_to_new_.size()) + " places of " + std::to_string(width));
  }
}

}  // namespace meshorder
