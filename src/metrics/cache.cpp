// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/cache.hpp"

#include <meshorder/error.hpp>

#include <unistd.h>

#include <array>
#include <charconv>
#include <fstream>
#include <limits>
#include <map>
#include <utility>

namespace meshorder {
namespace {

struct Unit {
  char letter;
  int bits;
};
constexpr std::array kUnits{Unit{'G', 30}, Unit{'M', 20}, Unit{'K', 10}};

/// "48K"; −1 for what is no size.
Offset parse_size(std::string_view text) {
  int bits = 0;
  for (const Unit& unit : kUnits) {
    const bool upper = !text.empty() && text.back() == unit.letter;
    const bool lower = !text.empty() && text.back() == unit.letter - 'A' + 'a';
    if (!upper && !lower) continue;
    bits = unit.bits;
    text.remove_suffix(1);
    break;
  }
  Offset number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && number >= 0 && number <= std::numeric_limits<Offset>::max() >> bits ? number << bits : -1;
}

/// The levels that are larger than all before them.
Caches rising(const std::vector<Offset>& sizes) {
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

Caches caches_in_sysfs() {
  std::map<int, Offset> size_of_level;
  for (int i = 0;; ++i) {
    const std::string folder = "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i) + "/";
    std::ifstream level_file(folder + "level"), type_file(folder + "type"), size_file(folder + "size");
    int level = 0;
    std::string type, size;
    if (!(level_file >> level) || !(type_file >> type) || !(size_file >> size)) break;
    if (type != "Instruction") size_of_level[level] = parse_size(size);
  }
  std::vector<Offset> sizes;
  sizes.reserve(size_of_level.size());
  for (const auto& [level, size] : size_of_level) sizes.push_back(size);
  return rising(sizes);
}

Caches caches_in_sysconf() {
  std::vector<Offset> sizes;
#ifdef _SC_LEVEL1_DCACHE_SIZE
  for (const int name : {_SC_LEVEL1_DCACHE_SIZE, _SC_LEVEL2_CACHE_SIZE, _SC_LEVEL3_CACHE_SIZE}) {
    sizes.push_back(sysconf(name));
  }
#endif
  return rising(sizes);
}

}  // namespace

Caches caches_of_this_machine() {
  Caches caches = caches_in_sysfs();
  if (caches.level_bytes.empty()) caches = caches_in_sysconf();
  if (caches.level_bytes.empty()) caches = parse_caches("32K,512K,16M");
  return caches;
}

Caches caches_of_the_paper() { return parse_caches("32K,256K,10M"); }

Caches parse_caches(std::string_view text) {
  if (text.empty() || text == "this") return caches_of_this_machine();
  if (text == "paper") return caches_of_the_paper();
  Caches caches;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view size_text = text.substr(begin, end - begin);
    const Offset size = parse_size(size_text);
    if (size <= 0 || size % kLineBytes != 0) {
      throw InvalidArgument("caches: \"" + std::string(size_text) +
                            "\" is no size of a cache; \"48K,1M,32M\", \"this\" or \"paper\" would be right");
    }
    if (!caches.level_bytes.empty() && size <= caches.level_bytes.back()) {
      throw InvalidArgument("caches: the sizes \"" + std::string(text) + "\" must rise from level to level");
    }
    caches.level_bytes.push_back(size);
    begin = end + 1;
  }
  return caches;
}

std::string to_string(const Caches& caches) {
  std::string text;
  for (const Offset bytes : caches.level_bytes) {
    if (!text.empty()) text += ',';
    Offset number = bytes;
    std::string letter;
    for (const Unit& unit : kUnits) {
      if (bytes % (Offset{1} << unit.bits) != 0) continue;
      number = bytes >> unit.bits;
      letter = unit.letter;
      break;
    }
    text += std::to_string(number) + letter;
  }
  return text;
}

std::vector<Offset> misses(const ReuseHistogram& histogram, const Caches& caches) {
  std::vector<Offset> result;
  result.reserve(caches.level_bytes.size());
  for (const Offset bytes : caches.level_bytes) result.push_back(histogram.misses(bytes / kLineBytes));
  return result;
}

}  // namespace meshorder
