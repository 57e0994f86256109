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

/// What parts have about equally much of.
enum class Balance : std::uint8_t {
  vertices,
  cells,  ///< elements, each shared out among its vertices in equal shares
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

/// Weight of an element: a number that most numbers of vertices divide, so that shares are whole.
inline constexpr GlobalIndex kElementWeight = 840;

/// Returns the shares of each own vertex in the elements that use it. Every rank has to call it.
/// O(entries · log).
///
/// @param layout    of the vertices
/// @param elements  vertices of the elements that this rank has; each element on one rank
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<GlobalIndex> shares_in_elements(const Communicator& communicator,
                                                          const Layout& layout, const Rows& elements);

/// Returns the weight of the heaviest part relative to the mean; 1 without weights. Every rank has to call
/// it. O(vertices + parts).
///
/// @param part_of  of each own vertex
/// @param weights  of each own vertex; none: all alike
/// @throws as `Communicator::exchange`
[[nodiscard]] double imbalance_of(const Communicator& communicator, const std::vector<Index>& part_of,
                                  const std::vector<GlobalIndex>& weights, Index parts);

}  // namespace meshorder::distributed
