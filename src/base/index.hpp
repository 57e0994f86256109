// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/number_view.hpp>

#include <limits>

namespace meshorder {

inline constexpr Index kMaxIndex = std::numeric_limits<Index>::max();

/// Returns the number of entries of a container that holds at most kMaxIndex of them.
template <class Container>
constexpr Index index_size(const Container& container) noexcept {
  return static_cast<Index>(container.size());
}

}  // namespace meshorder
