// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "distributed/comm/layout.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace meshorder::distributed {

/// Returns the part of a vertex by its new number. Vertices that no element uses come after the last part and
/// are counted in it. O(log parts).
///
/// @param starts  first new number of each part, then the end of the last part
[[nodiscard]] inline Index part_of(GlobalIndex vertex, const std::vector<GlobalIndex>& starts) {
  const auto behind = std::upper_bound(starts.begin() + 1, starts.end() - 1, vertex);
  return static_cast<Index>(behind - starts.begin()) - 1;
}

/// Returns the part of a cell: that of the largest new number of its vertices (at least one), so that the
/// parts of cells in the order `lexmax` ascend. O(vertices + log parts).
template <class Number>
[[nodiscard]] Index part_of_cell(std::span<const Number> vertices, const std::vector<GlobalIndex>& starts) {
  return part_of(*std::max_element(vertices.begin(), vertices.end()), starts);
}

}  // namespace meshorder::distributed
