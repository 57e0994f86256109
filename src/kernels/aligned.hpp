// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace meshorder {

/// Returns memory for `bytes` bytes; throws std::bad_alloc if there is none.
void* allocate_aligned(std::size_t bytes);
/// Frees what allocate_aligned returned for the same number of bytes.
void free_aligned(void* block, std::size_t bytes) noexcept;

/// Allocates at multiples of 64 bytes, so that batches of the kernels never straddle a cache line and every
/// order of a mesh is measured at the same alignment. Blocks of 1 MiB and more are put on pages of 2 MiB if
/// the system has such pages: gathers then need fewer look-ups in the page tables, and prefetchers stop at
/// fewer page ends.
template <class T>
struct AlignedAllocator {
  using value_type = T;

  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>& /*other*/) noexcept {}

  [[nodiscard]] T* allocate(std::size_t count) {
    return static_cast<T*>(allocate_aligned(count * sizeof(T)));
  }
  void deallocate(T* block, std::size_t count) noexcept { free_aligned(block, count * sizeof(T)); }

  bool operator==(const AlignedAllocator&) const = default;
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace meshorder
