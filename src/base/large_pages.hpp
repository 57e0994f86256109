// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/run_scope.hpp"

#include <algorithm>
#include <cstddef>

namespace meshorder {

/// Asks the system for large pages under memory that is about to be filled, as NumPy does for its arrays: one
/// fault for 2 MiB instead of 512. A hint, without effect on smaller blocks and other systems than Linux.
void ask_for_large_pages(void* memory, std::size_t bytes) noexcept;

/// Has the system clear the pages of memory that is about to be filled, on all threads; touching the memory
/// would do so on one. Polls. A hint, without effect on smaller blocks and other systems than Linux.
void clear_pages(void* memory, std::size_t bytes);

/// Like `container.reserve(size)`, and asks for large pages if it allocates. It then reserves at least twice
/// the container's size, so that growing in many steps takes linear time.
template <class Container>
void reserve_large(Container& container, std::size_t size) {
  if (size <= container.capacity()) return;
  container.reserve(std::max(size, 2 * container.size()));
  ask_for_large_pages(container.data(), container.capacity() * sizeof(*container.data()));
}

/// Like `container.resize(size)`, by `reserve_large` and `clear_pages`. Polls.
template <class Container>
void resize_large(Container& container, std::size_t size) {
  reserve_large(container, size);
  constexpr std::size_t kStep = (std::size_t{1} << 25) / sizeof(*container.data());
  if (const std::size_t old = container.size(); size > old)
    clear_pages(container.data() + old, (size - old) * sizeof(*container.data()));
  while (size > container.size() && size - container.size() > kStep) {
    poll();
    container.resize(container.size() + kStep);
  }
  container.resize(size);
}

}  // namespace meshorder
