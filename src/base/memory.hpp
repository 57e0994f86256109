// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/run_scope.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace meshorder {

/// Returns the bytes of memory that this process may use: the least of the machine's memory and the limits of
/// the process's address space and control groups. Computed once.
std::uint64_t usable_memory();

/// A limit on the memory of work whose size depends on the input.
struct MemoryLimit {
  std::uint64_t bytes = 0;
  bool is_given = false;  ///< whether `set_memory_limit` set it
};

/// Returns the limit of this process; three quarters of `usable_memory` if none was set.
MemoryLimit memory_limit();

/// Sets the limit for the rest of the process. Must not be called while other threads read or order.
void set_memory_limit(std::uint64_t bytes);

/// Returns count · bytes_each, or UINT64_MAX if the product overflows.
constexpr std::uint64_t bytes_for(std::uint64_t count, std::uint64_t bytes_each) {
  return bytes_each != 0 && count > UINT64_MAX / bytes_each ? UINT64_MAX : count * bytes_each;
}

/// A unit of sizes in text, such as G in "4G".
struct SizeUnit {
  char letter;
  int bits;  ///< the unit is 2^bits bytes
};
inline constexpr std::array kSizeUnits{SizeUnit{'G', 30}, SizeUnit{'M', 20}, SizeUnit{'K', 10}};

/// Returns the bytes that "48K", "32M", "4g" or "12" means; nothing for other texts and 2⁶³ bytes or more.
std::optional<std::uint64_t> parse_size(std::string_view text);

/// Returns a size as text, such as "64 GiB", "1.5 MiB" or "555 bytes".
std::string size_text(std::uint64_t bytes);

/// Asks the system for large pages under memory that is about to be filled, as NumPy does: 2 MiB then cost
/// one page fault instead of 512. A hint, without effect on smaller blocks and on systems other than Linux.
void ask_for_large_pages(void* memory, std::size_t bytes) noexcept;

/// Clears the pages of memory that is about to be filled, on all threads; otherwise one thread would clear
/// each page when it first touches the page. Calls `poll`. A hint, without effect on blocks below 32 MiB,
/// with one thread, and on systems other than Linux.
void clear_pages(void* memory, std::size_t bytes);

/// Like `container.reserve(size)`, but asks for large pages. An allocation reserves at least twice the
/// container's size, so that growing in many steps takes linear time.
template <class Container>
void reserve_large(Container& container, std::size_t size) {
  if (size <= container.capacity()) return;
  container.reserve(std::max(size, 2 * container.size()));
  ask_for_large_pages(container.data(), container.capacity() * sizeof(*container.data()));
}

/// Like `container.resize(size)`, but uses `reserve_large` and `clear_pages`, and calls `poll`.
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
