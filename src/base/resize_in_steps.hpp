// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/large_pages.hpp"
#include "base/run_scope.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace meshorder {

/// As `values.resize(size)`, on large pages and with polls where that takes long: the system clears memory
/// that is touched first.
template <class T>
void resize_in_steps(std::vector<T>& values, std::size_t size) {
  constexpr std::size_t kStep = (std::size_t{1} << 25) / sizeof(T);
  reserve_large(values, size);
  if (size <= kStep) return values.resize(size);
  while (values.size() < size) {
    poll();
    values.resize(std::min(size, values.size() + kStep));
  }
}

}  // namespace meshorder
