// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.hpp"
#include <meshorder/permutation.hpp>

#include <cstddef>
#include <vector>

namespace meshorder {

/// Returns `values` moved to their new places; each place has `width` values. O(n · width) time and memory.
///
/// @throws InvalidArgument if the sizes do not fit
template <class T>
std::vector<T> moved(const Permutation& order, const std::vector<T>& values, std::size_t width = 1) {
  std::vector<T> result;
  resize_large(result, values.size());
  order.move(values, result, width);
  return result;
}

}  // namespace meshorder
