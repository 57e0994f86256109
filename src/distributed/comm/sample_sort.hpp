// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"

#include <compare>
#include <cstdint>
#include <vector>

namespace meshorder::distributed {

/// An entry to be sorted by key, ties by number. No two numbers are equal.
struct SortEntry {
  std::uint64_t key;
  GlobalIndex number;

  auto operator<=>(const SortEntry&) const = default;
};

/// Sorts the entries of all ranks. Each rank gets a range of the result, in rank order; with many entries the
/// ranges have about the same size. Every rank has to call it. O(n log n) time for n entries of a rank, plus
/// the sorting of the samples at the root.
///
/// Regular sampling: Shi and Schaeffer, Parallel Sorting by Regular Sampling (1992).
///
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<SortEntry> sample_sorted(const Communicator& communicator,
                                                   std::vector<SortEntry> entries);

}  // namespace meshorder::distributed
