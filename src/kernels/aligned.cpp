// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/aligned.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace meshorder {
namespace {

constexpr std::align_val_t kCacheLine{64};
constexpr std::size_t kPageBytes = std::size_t{2} << 20;
constexpr std::size_t kMinPaged = kPageBytes / 2;

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  if (bytes < kMinPaged) return ::operator new(bytes, kCacheLine);
  // whole pages, since no other array may share the last one
  const std::size_t pages = (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
  void* const block = ::operator new (pages, std::align_val_t{kPageBytes});
#if defined(__linux__)
  // a hint; without it the pages have their ordinary size
  (void)madvise(block, pages, MADV_HUGEPAGE);
#endif
  return block;
}

void free_aligned(void* block, std::size_t bytes) noexcept {
  ::operator delete (block, bytes < kMinPaged ? kCacheLine : std::align_val_t{kPageBytes});
}

}  // namespace meshorder
