// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/apart.hpp"

#include <algorithm>
#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace meshorder {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kMinPaged = kHugePage / 2;
// malloc puts blocks from about here on at the same place of a page each
constexpr std::size_t kMinColoured = std::size_t{64} << 10;

// As many places in 4096 bytes as are all at least kApart from each other, the last one and the first one of
// the next page included.
constexpr std::size_t kColours = 3;
constexpr std::size_t kBetweenColours = 4096 / kColours / kCacheLine * kCacheLine;
static_assert(kBetweenColours >= kApart);
static_assert(4096 - (kColours - 1) * kBetweenColours >= kApart);

std::size_t alignment_of(std::size_t bytes) {
  if (bytes < kMinColoured) return kCacheLine;
  return bytes < kMinPaged ? 4096 : kHugePage;
}

/// Where in its page the next large block of this thread begins: in turns, so that any three arrays that are
/// made one after another are apart (see kApart), whatever other threads do.
std::size_t next_colour() {
  thread_local std::size_t turn = 0;
  turn = (turn + 1) % kColours;
  return turn * kBetweenColours;
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  const std::size_t alignment = alignment_of(bytes);
  if (alignment == kCacheLine) return ::operator new (bytes, std::align_val_t{kCacheLine});
  const std::size_t colour = next_colour();
  std::size_t room = bytes + colour;
  // whole pages, since no other array may share the last one
  if (alignment == kHugePage) room = (room + kHugePage - 1) / kHugePage * kHugePage;
  char* const block = static_cast<char*>(::operator new (room, std::align_val_t{alignment}));
#if defined(__linux__)
  // a hint; without it the pages have their ordinary size
  if (alignment == kHugePage) (void)madvise(block, room, MADV_HUGEPAGE);
#endif
  return block + colour;
}

void free_aligned(void* block, std::size_t bytes) noexcept {
  const std::size_t alignment = alignment_of(bytes);
  // colours are less than the alignment of the blocks that have them
  char* const start = static_cast<char*>(block) - reinterpret_cast<std::uintptr_t>(block) % alignment;
  ::operator delete (start, std::align_val_t{alignment});
}

bool aliases(const void* a, const void* b) noexcept {
  const std::size_t distance =
      (reinterpret_cast<std::uintptr_t>(a) - reinterpret_cast<std::uintptr_t>(b)) % 4096;
  return std::min(distance, 4096 - distance) < kApart;
}

}  // namespace meshorder
