// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"

#include <compare>
#include <cstdint>
#include <vector>

namespace meshorder::distributed {

/// What is sorted: by key, ties by number, of which no two are equal.
struct SortEntry {
  std::uint64_t key;
  GlobalIndex number;

  auto operator<=>(const SortEntry&) const = default;
};

/// Sorts the entries of all ranks: each rank gets a range of the result, in rank order, of about the same
/// size where there are many. Every rank has to call it. O(n log n + ranks² · samples) for n entries of a
/// rank.
///
/// Regular sampling: Shi and Schaeffer, Parallel Sorting by Regular Sampling (1992).
///
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<SortEntry> sample_sorted(const Communicator& communicator,
                                                   std::vector<SortEntry> entries);

}  // namespace meshorder::distributed
