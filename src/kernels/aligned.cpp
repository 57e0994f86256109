// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/memory.hpp"
#include "kernels/apart.hpp"

#include <algorithm>
#include <cstdint>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace meshorder {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kMinPaged = kHugePage / 2;
// malloc places most blocks from this size on at the same offset in a page
constexpr std::size_t kMinColoured = std::size_t{64} << 10;

// Large blocks begin at one of this many offsets in a page of 4096 bytes. The offsets are at least kApart
// from each other, modulo 4096.
constexpr std::size_t kColours = 3;
constexpr std::size_t kBetweenColours = 4096 / kColours / kCacheLine * kCacheLine;
static_assert(kBetweenColours >= kApart);
static_assert(4096 - (kColours - 1) * kBetweenColours >= kApart);

std::size_t alignment_of(std::size_t bytes) {
  if (bytes < kMinColoured) return kCacheLine;
  return bytes < kMinPaged ? 4096 : kHugePage;
}

/// Returns the offset within a page for this thread's next large block. Offsets rotate per thread: any three
/// large arrays that a thread makes one after another are apart (see kApart).
std::size_t next_colour() {
  thread_local std::size_t turn = 0;
  turn = (turn + 1) % kColours;
  return turn * kBetweenColours;
}

#if defined(__linux__)

/// Returns newly mapped memory that begins at a multiple of kHugePage; the heap might return memory on small
/// pages. Asks the system for large pages; the system may give ordinary ones.
void* allocate_pages(std::size_t bytes) {
  const std::size_t mapped = bytes + kHugePage;
  void* const map = mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (map == MAP_FAILED) throw std::bad_alloc();
  const std::size_t before = (kHugePage - reinterpret_cast<std::uintptr_t>(map) % kHugePage) % kHugePage;
  char* const block = static_cast<char*>(map) + before;
  if (before > 0) (void)munmap(map, before);
  (void)munmap(block + bytes, mapped - before - bytes);
  ask_for_large_pages(block, bytes);
  return block;
}

void free_pages(void* block, std::size_t bytes) noexcept { (void)munmap(block, bytes); }

#else

void* allocate_pages(std::size_t bytes) { return ::operator new (bytes, std::align_val_t{kHugePage}); }

void free_pages(void* block, std::size_t /*bytes*/) noexcept {
  ::operator delete (block, std::align_val_t{kHugePage});
}

#endif

/// Returns the total size of the large pages for an array that begins `colour` bytes after the start of the
/// first page. No other array may share the last page.
std::size_t bytes_of_pages(std::size_t bytes, std::size_t colour) {
  return (bytes + colour + kHugePage - 1) / kHugePage * kHugePage;
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  const std::size_t alignment = alignment_of(bytes);
  if (alignment == kCacheLine) return ::operator new (bytes, std::align_val_t{kCacheLine});
  const std::size_t colour = next_colour();
  void* const block = alignment == kHugePage ? allocate_pages(bytes_of_pages(bytes, colour))
                                             : ::operator new (bytes + colour, std::align_val_t{alignment});
  return static_cast<char*>(block) + colour;
}

void free_aligned(void* block, std::size_t bytes) noexcept {
  const std::size_t alignment = alignment_of(bytes);
  // the colour of a block is less than its alignment
  const std::size_t colour = reinterpret_cast<std::uintptr_t>(block) % alignment;
  char* const start = static_cast<char*>(block) - colour;
  if (alignment == kHugePage) return free_pages(start, bytes_of_pages(bytes, colour));
  ::operator delete (start, std::align_val_t{alignment});
}

bool aliases(const void* a, const void* b) noexcept {
  const std::size_t distance =
      (reinterpret_cast<std::uintptr_t>(a) - reinterpret_cast<std::uintptr_t>(b)) % 4096;
  return std::min(distance, 4096 - distance) < kApart;
}

}  // namespace meshorder
