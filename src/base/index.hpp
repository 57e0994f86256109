// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/number_view.hpp>

#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

namespace meshorder {

inline constexpr Index kMaxIndex = std::numeric_limits<Index>::max();

/// Returns the number of entries of a container that holds at most kMaxIndex of them.
template <class Container>
constexpr Index index_size(const Container& container) noexcept {
  return static_cast<Index>(container.size());
}

/// Returns first, first + 1, …, first + count − 1. O(count).
inline std::vector<Index> index_range(Index first, Index count) {
  std::vector<Index> range(static_cast<std::size_t>(count));
  std::iota(range.begin(), range.end(), first);
  return range;
}

}  // namespace meshorder
