// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/large_pages.hpp"

#if defined(__linux__)
#include "base/parallel.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#ifndef MADV_POPULATE_WRITE
#define MADV_POPULATE_WRITE 23  // Linux 5.14; headers of Debian 11 and others lack it
#endif
#endif

namespace meshorder {

#if defined(__linux__)
namespace {

constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// The whole small pages of a block: its neighbours are not ours.
struct Pages {
  char* begin;
  std::size_t bytes;

  Pages(void* memory, std::size_t size) {
    static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(memory) % page) % page;
    begin = static_cast<char*>(memory) + before;
    bytes = size <= before ? 0 : (size - before) / page * page;
  }
};

}  // namespace
#endif

void ask_for_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(__linux__)
  if (bytes < kLargePage) return;
  const Pages pages(memory, bytes);
  (void)::madvise(pages.begin, pages.bytes, MADV_HUGEPAGE);
#endif
}

void clear_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  constexpr std::size_t kAtOnce = 8 * kLargePage;
  // one thread had better clear each page when it fills it, while the page is in the cache
  if (bytes < 2 * kAtOnce || thread_count() < 2) return;
  const Pages pages(memory, bytes);
  for_each_range(static_cast<Offset>(pages.bytes), Offset{kAtOnce}, [&](Offset begin, Offset end) {
    (void)::madvise(pages.begin + begin, static_cast<std::size_t>(end - begin), MADV_POPULATE_WRITE);
  });
#endif
}

}  // namespace meshorder
