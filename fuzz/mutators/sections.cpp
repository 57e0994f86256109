// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Files in parts (Gmsh's sections, PLY's header and numbers): a change leaves all parts but one whole.
#include "fuzz/families/families.hpp"
#include "fuzz/mutators/choice.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace meshorder::fuzz {
namespace {

constexpr std::size_t kRoom = 256;  // bytes by which a part may grow

/// Whole numbers that are often handled wrongly.
constexpr std::array<std::int64_t, 14> kLimits{0,
                                               1,
                                               -1,
                                               2,
                                               127,
                                               255,
                                               65535,
                                               1LL << 31U,
                                               (1LL << 31U) - 1,
                                               -(1LL << 31U),
                                               1LL << 32U,
                                               1LL << 62U,
                                               std::numeric_limits<std::int64_t>::max(),
                                               std::numeric_limits<std::int64_t>::min()};

/// Puts a number of 4 or 8 bytes into binary data, at a multiple of 4 bytes after `begin`.
void put_number(std::string& bytes, std::size_t begin, Choice& choice) {
  const std::size_t width = choice.below(2) == 0 ? 4 : 8;
  if (bytes.size() < begin + width) return;
  const std::size_t at = begin + choice.below((bytes.size() - begin - width) / 4 + 1) * 4;
  std::int64_t value = 0;
  if (choice.below(2) == 0) {
    value = kLimits[choice.below(kLimits.size())];
  } else {  // near the present number
    std::memcpy(&value, bytes.data() + at, width);
    value = static_cast<std::int64_t>(static_cast<std::uint64_t>(value) + choice.below(9) - 4);
  }
  std::memcpy(bytes.data() + at, &value, width);
}

/// Splits a text before each line, except the first, that begins with "$" but not with "$End".
std::vector<std::string> sections_of(std::string_view text) {
  std::vector<std::string> sections(1);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find("\n$", at + 1), text.size());
    if (text.substr(end, 5) == "\n$End" || end == text.size()) {
      sections.back() += text.substr(at, end - at);
    } else {
      sections.back() += text.substr(at, end + 1 - at);
      sections.emplace_back();
      at = end + 1;
      continue;
    }
    at = end;
  }
  return sections;
}

}  // namespace

std::string mutate_sections(std::string input, std::uint32_t seed) {
  Choice choice(seed);
  std::vector<std::string> sections = sections_of(input);
  const std::size_t at = choice.below(sections.size());
  std::string& section = sections[at];
  switch (choice.below(5)) {
    case 0:
      std::swap(section, sections[choice.below(sections.size())]);
      break;
    case 1:
      section += std::string(section);
      break;
    case 2:
      section.clear();
      break;
    case 3: {
      const std::size_t line_end = std::min(section.find('\n'), section.size());
      put_number(section, std::min(line_end + 1, section.size()), choice);
      break;
    }
    default:
      section = mutated_bytes(section, section.size() + kRoom);
  }
  std::string result;
  for (const std::string& part : sections) result += part;
  return result;
}

std::string mutate_ply(std::string input, std::uint32_t seed) {
  constexpr std::string_view kEnd = "end_header\n";
  Choice choice(seed);
  const auto end = input.find(kEnd);
  if (end == std::string::npos) return {};
  std::string header = input.substr(0, end + kEnd.size());
  std::string numbers = input.substr(end + kEnd.size());
  switch (choice.below(3)) {
    case 0:
      header = mutated_bytes(header, header.size() + kRoom);
      break;
    case 1:
      put_number(numbers, choice.below(4), choice);
      break;
    default:
      numbers = mutated_bytes(numbers, numbers.size() + kRoom);
  }
  return header + numbers;
}

}  // namespace meshorder::fuzz
