// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::distributed {

/// The quantity that is balanced among the parts.
enum class Balance : std::uint8_t {
  vertices,
  cells,  ///< each element divides its weight equally among its vertices
};

}  // namespace meshorder::distributed

namespace meshorder {

template <>
struct EnumNames<distributed::Balance> {
  static constexpr std::string_view kind = "balance";
  static constexpr std::array names{std::pair{distributed::Balance::vertices, "vertices"},
                                    std::pair{distributed::Balance::cells, "cells"}};
};

}  // namespace meshorder

namespace meshorder::distributed {

/// Weight of an element: divisible by the vertex counts of most shapes, so that shares are integers.
inline constexpr GlobalIndex kElementWeight = 840;

/// Returns the weight of each vertex of this rank: the sum of its shares in all elements that use it. Every
/// rank has to call it. O(entries · log entries) at most.
///
/// @param layout    the owners of the vertices
/// @param elements  vertices of the elements on this rank; each element is on one rank
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<GlobalIndex> shares_in_elements(const Communicator& communicator,
                                                          const Layout& layout, const Rows& elements);

/// Returns (weight of the heaviest part) / (mean weight of a part); 1 if all are 0. Every rank has to call
/// it. O(vertices + parts).
///
/// @param part_of  part of each vertex of this rank
/// @param weights  weight of each vertex of this rank; empty: all 1
/// @throws as `Communicator::exchange`
[[nodiscard]] double imbalance_of(const Communicator& communicator, const std::vector<Index>& part_of,
                                  const std::vector<GlobalIndex>& weights, Index parts);

}  // namespace meshorder::distributed
