// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace meshorder::distributed {

/// Vertices or cells sorted by the numbers (ids) that their file gives them.
struct NumberOrder {
  std::vector<GlobalIndex> sorted;    ///< positions in the file, sorted by number: this rank's range
  std::optional<std::int64_t> twice;  ///< the smallest number that occurs twice
};

/// Sorts the numbers of vertices or cells. Every rank has to call it. O(n log n) time for n numbers of a
/// rank.
///
/// @param layout   the owners of the vertices or cells
/// @param numbers  numbers of this rank's vertices or cells, in the order of the file
/// @throws as `Communicator::exchange`
[[nodiscard]] NumberOrder order_of_numbers(const Communicator& communicator, const Layout& layout,
                                           const std::vector<std::int64_t>& numbers);

/// Returns whether the numbers of all ranks, one rank after another, are 1, 2, …. Every rank has to call it.
/// O(numbers).
[[nodiscard]] bool are_places(const Communicator& communicator, const Layout& layout,
                              const std::vector<std::int64_t>& numbers);

}  // namespace meshorder::distributed
