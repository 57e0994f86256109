// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/cache.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace meshorder {
namespace {

struct Unit {
  char letter;
  int bits;
};
constexpr std::array kUnits{Unit{'G', 30}, Unit{'M', 20}, Unit{'K', 10}};

/// Returns the bytes of "48K", −1 if the text is not a size.
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

}  // namespace

Caches parse_cache_sizes(std::string_view text) {
  Caches caches;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view size_text = text.substr(begin, end - begin);
    const Offset size = parse_size(size_text);
    if (size <= 0 || size % kLineBytes != 0) {
      throw InvalidArgument("caches: \"" + std::string(size_text) +
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
