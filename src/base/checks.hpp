// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"
#include <meshorder/number_view.hpp>

#include <atomic>
#include <cstdint>
#include <span>

namespace meshorder {

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

/// Returns whether `holds(begin, end)` for all parts of 0 … n−1, which all threads share.
template <class Holds>
bool holds_for_all(Offset n, const Holds& holds) {
  constexpr Offset kAtOnce = 65536;
  std::atomic<bool> all = true;
  for_each_range(n, kAtOnce, [&](Offset begin, Offset end) {
    if (all.load(std::memory_order_relaxed) && !holds(begin, end))
      all.store(false, std::memory_order_relaxed);
  });
  return all;
}

}  // namespace meshorder
