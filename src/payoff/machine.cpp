// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/machine.hpp"

#include "base/text.hpp"
#include "kernels/simd_dispatch.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace meshorder {
namespace {

/// Returns the caches of these sizes, rounded down to whole lines; skips a size that is not larger than all
/// before it.
Caches ascending(const std::vector<Offset>& sizes) {
  Caches caches;
  Offset largest = 0;
  for (const Offset size : sizes) {
    const Offset whole_lines = size - size % kLineBytes;
    if (whole_lines <= largest) continue;
    caches.level_bytes.push_back(whole_lines);
    largest = whole_lines;
  }
  return caches;
}

/// Returns how many processors a list such as "0-3,8" has.
int processors_in(const std::string& list) {
  int count = 0;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');) {
    int first = 0;
    int last = 0;
    char dash = 0;
    std::istringstream range(part);
    if (!(range >> first)) continue;
    count += range >> dash >> last ? std::max(1, last - first + 1) : 1;
  }
  return count;
}

Caches caches_in_sysconf() {
  std::vector<Offset> sizes;
#ifdef _SC_LEVEL1_DCACHE_SIZE
  for (const int name : {_SC_LEVEL1_DCACHE_SIZE, _SC_LEVEL2_CACHE_SIZE, _SC_LEVEL3_CACHE_SIZE}) {
    sizes.push_back(sysconf(name));
  }
#endif
  return ascending(sizes);
}

/// Returns a text that is the same for all hardware threads of a core: their numbers, as the system lists
/// them.
std::string core_of(int processor) {
  std::ifstream in("/sys/devices/system/cpu/cpu" + std::to_string(processor) +
                   "/topology/thread_siblings_list");
  std::string siblings;
  return std::getline(in, siblings) ? siblings : std::to_string(processor);
}

}  // namespace

Caches caches_in(const std::string& folder) {
  // No processor of today has more cache for each of its threads. A virtual machine's system may report all
  // of a cache that other machines use, too; then a usual share is assumed.
  constexpr Offset kMostOfAThread = Offset{16} << 20;
  constexpr Offset kShareOfAThread = Offset{4} << 20;
  std::map<int, Offset> size_of_level;
  for (int i = 0;; ++i) {
    const std::string index = folder + "/index" + std::to_string(i) + "/";
    std::ifstream level_file(index + "level"), type_file(index + "type"), size_file(index + "size");
    int level = 0;
    std::string type;
    Offset kilobytes = 0;  // Linux writes "48K"; reading a number stops at the K
    if (!(level_file >> level) || !(type_file >> type) || !(size_file >> kilobytes)) break;
    std::ifstream shared_file(index + "shared_cpu_list");
    std::string shared;
    std::getline(shared_file, shared);
    const int threads = std::max(1, processors_in(shared));
    const Offset bytes = kilobytes << 10;
    if (type != "Instruction")
      size_of_level[level] = bytes > kMostOfAThread * threads ? kShareOfAThread * threads : bytes;
  }
  std::vector<Offset> sizes;
  sizes.reserve(size_of_level.size());
  for (const auto& [level, size] : size_of_level) sizes.push_back(size);
  return ascending(sizes);
}

Caches reported_caches() {
  const Caches caches = caches_in("/sys/devices/system/cpu/cpu0/cache");
  return caches.level_bytes.empty() ? caches_in_sysconf() : caches;
}

Caches caches_of_this_machine() {
  Caches caches = reported_caches();
  if (caches.level_bytes.empty()) caches = parse_cache_sizes("32K,512K,16M");
  return caches;
}

Caches caches_of_the_paper() { return parse_cache_sizes("32K,256K,10M"); }

Caches parse_caches(std::string_view text) {
  if (text.empty() || text == "this") return caches_of_this_machine();
  return text == "paper" ? caches_of_the_paper() : parse_cache_sizes(text);
}

std::string build_of_this_program() {
  return std::string(MESHORDER_VERSION_TEXT) + ", " + MESHORDER_COMPILER + ", " +
         std::string(trimmed(MESHORDER_FLAGS)) + ", " + simd_target();
}

std::vector<int> choose_processors(int threads) {
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof(allowed), &allowed) != 0) return {};
  std::vector<int> firsts, others;  // the first of each core, then the rest
  std::set<std::string> cores;
  for (int processor = CPU_SETSIZE - 1; processor >= 0; --processor) {
    if (!CPU_ISSET(static_cast<std::size_t>(processor), &allowed)) continue;
    (cores.insert(core_of(processor)).second ? firsts : others).push_back(processor);
  }
  firsts.insert(firsts.end(), others.begin(), others.end());
  if (static_cast<int>(firsts.size()) < threads) return {};
  firsts.resize(static_cast<std::size_t>(threads));
  std::sort(firsts.begin(), firsts.end());
  return firsts;
}

bool bind_to(const std::vector<int>& processors) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int processor : processors) CPU_SET(static_cast<std::size_t>(processor), &set);
  return ::sched_setaffinity(0, sizeof(set), &set) == 0;
}

}  // namespace meshorder
