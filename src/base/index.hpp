// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

namespace meshorder {

/// Number of a vertex, a cell or a row of a matrix: at most 2,147,483,647 of them.
using Index = std::int32_t;

/// Position in an array that holds several entries for each vertex or cell; such arrays outgrow 32 bits.
using Offset = std::int64_t;

inline constexpr Index kMaxIndex = std::numeric_limits<Index>::max();

/// The number of entries of a container that is known to hold at most kMaxIndex of them.
template <class Container>
constexpr Index index_size(const Container& container) noexcept {
  return static_cast<Index>(container.size());
}

}  // namespace meshorder
