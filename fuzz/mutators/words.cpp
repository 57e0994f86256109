// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Files of lines and words: lines are moved, copied and removed, words are exchanged. Names then occur twice
// and numbers refer to other items, while readers still understand the lines.
#include "fuzz/families/families.hpp"
#include "fuzz/mutators/choice.hpp"

#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::fuzz {
namespace {

constexpr std::string_view kBetweenWords = " \t\r\n,;=()/";

/// Returns the parts of a text between the separators; no part is empty.
std::vector<std::string_view> parts_of(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto begin = text.find_first_not_of(separators);
    if (begin == std::string_view::npos) return parts;
    text.remove_prefix(begin);
    parts.push_back(text.substr(0, text.find_first_of(separators)));
    text.remove_prefix(parts.back().size());
  }
}

/// Returns the text with `part` replaced by `for_part`.
std::string with(std::string_view text, std::string_view part, std::string_view for_part) {
  std::string result(text.data(), part.data());
  result += for_part;
  result.append(part.data() + part.size(), text.data() + text.size());
  return result;
}

/// Returns the text with two parts exchanged; the parts must not overlap.
std::string exchanged(std::string_view text, std::string_view one, std::string_view other) {
  if (one.data() > other.data()) std::swap(one, other);
  const std::string_view before = text.substr(0, static_cast<std::size_t>(other.data() - text.data()));
  return with(before, one, other) + std::string(one) +
         std::string(other.data() + other.size(), text.data() + text.size());
}

/// Returns a whole number near the number in `word`; `other` if the word is not a number.
std::string near_number(std::string_view word, std::string_view other, Choice& choice) {
  std::int64_t number = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (fault != std::errc() || end != word.data() + word.size()) return std::string(other);
  // may wrap around
  return std::to_string(static_cast<std::int64_t>(static_cast<std::uint64_t>(number) + choice.below(5) - 2));
}

}  // namespace

std::string mutate_words(std::string input, std::uint32_t seed) {
  Choice choice(seed);
  const bool by_lines = choice.below(3) == 0;
  const std::vector<std::string_view> parts = parts_of(input, by_lines ? "\n" : kBetweenWords);
  if (parts.empty()) return {};
  const std::string_view one = parts[choice.below(parts.size())];
  const std::string_view other = parts[choice.below(parts.size())];
  const std::size_t change = one.data() == other.data() ? 3 : choice.below(4);
  if (change == 0) return with(input, one, other);
  if (change == 1) return exchanged(input, one, other);
  if (!by_lines) return with(input, one, near_number(one, other, choice));
  return with(input, one, change == 2 ? std::string(one) + '\n' + std::string(other) : std::string());
}

}  // namespace meshorder::fuzz
