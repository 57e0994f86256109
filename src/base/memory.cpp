// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/memory.hpp"

#include "base/parallel.hpp"
#include "base/text.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>

#if defined(__linux__) && !defined(MADV_POPULATE_WRITE)
#define MADV_POPULATE_WRITE 23  // Linux 5.14; headers of Debian 11 and others lack it
#endif

namespace meshorder {
namespace {

namespace fs = std::filesystem;

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): of the process
MemoryLimit given_limit;

/// Returns the least memory limit of a control group and the groups around it; `root` has their folders.
std::uint64_t limit_of_group(const fs::path& root, fs::path group, const char* file) {
  std::uint64_t least = UINT64_MAX;
  while (true) {
    std::uint64_t limit = 0;
    // "max" means no limit; reading it as a number fails
    if (std::ifstream stream(root / group.relative_path() / file); stream >> limit) {
      least = std::min(least, limit);
    }
    if (!group.has_relative_path()) return least;
    group = group.parent_path();
  }
}

/// Returns the least memory limit of the control groups, version 1 or 2, of this process.
std::uint64_t limit_of_groups() {
  constexpr const char* kRoot = "/sys/fs/cgroup";
  std::uint64_t least = UINT64_MAX;
  std::ifstream groups("/proc/self/cgroup");
  // "NUMBER:CONTROLLERS:PATH", in version 2 "0::PATH"
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    std::string controllers = ",";
    controllers.append(line, first + 1, second - first - 1).append(",");
    const std::string group = line.substr(second + 1);
    if (controllers == ",,") {
      least = std::min(least, limit_of_group(kRoot, group, "memory.max"));
    } else if (controllers.find(",memory,") != std::string::npos) {
      const fs::path root = fs::path(kRoot) / "memory";
      least = std::min(least, limit_of_group(root, group, "memory.limit_in_bytes"));
    }
  }
  return least;
}

std::uint64_t find_usable_memory() {
  const auto pages = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES));
  std::uint64_t least = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    least = std::min<std::uint64_t>(least, space.rlim_cur);
  }
  return std::min(least, limit_of_groups());
}

#if defined(__linux__)
constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// The pages that lie entirely in a block of memory: pages at its ends may also hold other data.
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
#endif

}  // namespace

std::uint64_t usable_memory() {
  static const std::uint64_t bytes = find_usable_memory();
  return bytes;
}

MemoryLimit memory_limit() {
  return given_limit.is_given ? given_limit : MemoryLimit{usable_memory() / 4 * 3, false};
}

void set_memory_limit(std::uint64_t bytes) { given_limit = {bytes, true}; }

std::optional<std::uint64_t> parse_size(std::string_view text) {
  int bits = 0;
  for (const auto& [letter, bits_of_unit] : kSizeUnits) {
    if (text.empty() || lower_case(text.back()) != lower_case(letter)) continue;
    bits = bits_of_unit;
    text.remove_suffix(1);
    break;
  }
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || number < 0 || number > std::numeric_limits<std::int64_t>::max() >> bits) return {};
  return static_cast<std::uint64_t>(number) << bits;
}

std::string size_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 6> kUnits{" KiB", " MiB", " GiB", " TiB", " PiB", " EiB"};
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  double size = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  for (; size >= 1024 && unit + 1 < kUnits.size(); ++unit) size /= 1024;
  constexpr int kDigits = 4;
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), size, std::chars_format::general, kDigits).ptr;
  return std::string(text.data(), end) + kUnits[unit];
}

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
  // with one thread, clearing each page just before filling it is faster: the page is then in the cache
  if (bytes < 2 * kAtOnce || thread_count() < 2) return;
  const Pages pages(memory, bytes);
  for_each_range(static_cast<Offset>(pages.bytes), Offset{kAtOnce}, [&](Offset begin, Offset end) {
    (void)::madvise(pages.begin + begin, static_cast<std::size_t>(end - begin), MADV_POPULATE_WRITE);
  });
#endif
}

}  // namespace meshorder
