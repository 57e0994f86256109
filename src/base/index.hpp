// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/number_view.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
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

/// Returns whether all numbers are in 0 … limit − 1, limit ≥ 0. O(numbers). The loop has no branches, so that
/// compilers vectorise it: it combines the sign bits of each number and of (limit − 1) − number.
inline bool all_below(std::span<const Index> numbers, Index limit) noexcept {
  const std::uint32_t last = static_cast<std::uint32_t>(limit) - 1;
  std::uint32_t signs = 0;
  for (const Index number : numbers) {
    const auto bits = static_cast<std::uint32_t>(number);
    signs |= bits | (last - bits);
  }
  return limit > 0 ? signs >> 31U == 0 : numbers.empty();
}

/// Calls `work` with the numbers of a view as a span of their own type and returns its result. `work` must
/// have the same result type for all four number types.
template <class Work>
decltype(auto) with_type(const IndexView& numbers, const Work& work) {
  const auto as = [&]<class T>(T) {
    return std::span(static_cast<const T*>(numbers.data()), numbers.size());
  };
  if (numbers.bytes() == 4) return numbers.is_signed() ? work(as(std::int32_t{})) : work(as(std::uint32_t{}));
  return numbers.is_signed() ? work(as(std::int64_t{})) : work(as(std::uint64_t{}));
}

/// The same for numbers that `work` changes.
template <class Work>
decltype(auto) with_type(const IndexSpan& numbers, const Work& work) {
  const auto as = [&]<class T>(T) { return std::span(static_cast<T*>(numbers.data()), numbers.size()); };
  if (numbers.bytes() == 4) return numbers.is_signed() ? work(as(std::int32_t{})) : work(as(std::uint32_t{}));
  return numbers.is_signed() ? work(as(std::int64_t{})) : work(as(std::uint64_t{}));
}

/// The same for real numbers.
template <class Work>
decltype(auto) with_type(const RealView& numbers, const Work& work) {
  if (numbers.bytes() == 4) return work(std::span(static_cast<const float*>(numbers.data()), numbers.size()));
  return work(std::span(static_cast<const double*>(numbers.data()), numbers.size()));
}

}  // namespace meshorder
