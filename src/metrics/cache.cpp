// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/cache.hpp"

#include "base/memory.hpp"
#include <meshorder/error.hpp>

#include <algorithm>

namespace meshorder {

Caches parse_cache_sizes(std::string_view text) {
  Caches caches;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    const auto size = static_cast<Offset>(parse_size(word).value_or(0));
    if (size <= 0 || size % kLineBytes != 0) {
      throw InvalidArgument("caches: \"" + std::string(word) +
                            "\" is not a cache size; give sizes such as 48K,1M,32M");
    }
    if (!caches.level_bytes.empty() && size <= caches.level_bytes.back()) {
      throw InvalidArgument("caches: the sizes \"" + std::string(text) +
                            "\" must increase from level to level");
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
    for (const SizeUnit& unit : kSizeUnits) {
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
