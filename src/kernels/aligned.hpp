// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cstddef>
#include <new>
#include <vector>

namespace meshorder {

/// Allocates on cache lines, so that the batches of the kernels never straddle one and every order of a mesh
/// is measured at the same alignment. What takes 1 MiB or more is put on pages of 2 MiB where the system has
/// them: gathers then miss no page tables, and prefetchers stop at fewer ends of pages.
template <class T>
struct AlignedAllocator {
  using value_type = T;

  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>& /*other*/) noexcept {}

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kLeastPaged) return static_cast<T*>(::operator new(bytes, kCacheLine));
    // whole pages, since no other array may share the last one
    const std::size_t pages = (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
    void* const block = ::operator new (pages, std::align_val_t{kPageBytes});
#if defined(__linux__)
    // a hint; without it the pages are as small as ever
    (void)madvise(block, pages, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(block);
  }
  void deallocate(T* block, std::size_t count) noexcept {
    ::operator delete (block, count * sizeof(T) < kLeastPaged ? kCacheLine : std::align_val_t{kPageBytes});
  }

  bool operator==(const AlignedAllocator&) const = default;

 private:
  static constexpr std::align_val_t kCacheLine{64};
  static constexpr std::size_t kPageBytes = std::size_t{2} << 20;
  static constexpr std::size_t kLeastPaged = kPageBytes / 2;
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace meshorder
