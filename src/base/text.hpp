// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace meshorder {

/// Returns "; did you mean 'order'?" if a name is spelt or begins nearly like `word`; else "".
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

/// Returns "unknown workload 'spring'; did you mean 'springs'?", or "unknown workload 'a'; known: …" if no
/// name is near.
std::string unknown_in_words(std::string_view kind, const std::string& word,
                             const std::vector<std::string>& names);

/// Returns the items as one text, separated by `separator`. `text_of(item)` gives the text of an item.
template <class Items, class TextOf>
std::string join(const Items& items, TextOf text_of, std::string_view separator = ", ") {
  std::string result;
  bool first = true;
  for (const auto& item : items) {
    if (!first) result += separator;
    first = false;
    result += text_of(item);
  }
  return result;
}

/// Returns the texts as one text, separated by `separator`.
template <class Texts>
std::string join(const Texts& texts, std::string_view separator = ", ") {
  return join(
      texts, [](const auto& text) -> const auto& { return text; }, separator);
}

/// Returns whether `c` is a blank within a line, as in C: a space, tab, form feed or vertical tab.
constexpr bool is_blank(char c) { return c == ' ' || (c < ' ' && (c == '\t' || c == '\f' || c == '\v')); }

/// Returns `text` without blanks at its ends.
inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Removes the next word from the front of `line` and returns the word; empty if no word is left. Words are
/// separated by blanks and by the characters of `marks`.
inline std::string_view next_word(std::string_view& line, std::string_view marks = {}) {
  // words and marks are short: a loop is faster than the functions of string_view, which call memchr
  const auto separates = [&](char c) {
    return is_blank(c) || std::any_of(marks.begin(), marks.end(), [c](char mark) { return c == mark; });
  };
  const char* const end = line.data() + line.size();
  const char* const begin = std::find_if_not(line.data(), end, separates);
  const char* const after = std::find_if(begin, end, separates);
  line.remove_prefix(static_cast<std::size_t>(after - line.data()));
  return {begin, static_cast<std::size_t>(after - begin)};
}

/// Returns an ASCII letter in lower case, and other bytes unchanged, in any locale: in Turkish,
/// std::tolower('I') is not 'i'.
constexpr char lower_case(char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Returns the text with its ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// Returns the text with its ASCII letters in upper case.
std::string upper_case(std::string_view text);

/// Returns whether two words differ at most in the case of ASCII letters.
constexpr bool same_but_for_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower_case(x) == lower_case(y); });
}

/// Returns `text` with escapes in place of bytes that are not UTF-8, and of characters that a terminal acts
/// on: control characters other than those in `kept`, and characters that change the direction of writing. A
/// character becomes "\u001b", a byte "\xff". O(size).
std::string visible(std::string_view text, std::string_view kept = {});

/// Returns whether `text` is UTF-8. O(size).
bool is_utf8(std::string_view text);

/// Returns the longest prefix of `text` of at most `most` bytes that does not end within a UTF-8 character.
std::string_view utf8_prefix(std::string_view text, std::size_t most);

/// Returns `text` with escapes, like those of `visible`, for characters that XML cannot hold: characters
/// below U+0020 other than tab and line ends, U+FFFE, U+FFFF, and bytes that are not UTF-8. O(size).
std::string xml_text(std::string_view text);

/// Returns `xml_text(text)` escaped for an XML attribute between double quotes. O(size).
std::string xml_escaped(std::string_view text);

/// The names of an enumeration's values, the same in the command, in JSON and in messages. A specialisation
/// lists all values once:
///
///     template <>
///     struct EnumNames<Colour> {
///       static constexpr std::string_view kind = "colour";
///       static constexpr std::array names{std::pair{Colour::red, "red"}, std::pair{Colour::blue, "blue"}};
///     };
template <class Enum>
struct EnumNames;

template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires {
  EnumNames<Enum>::names.size();
};

/// Returns the name of `value`; an empty text if `value` has none.
template <NamedEnum Enum>
constexpr std::string_view to_string(Enum value) {
  for (const auto& [candidate, name] : EnumNames<Enum>::names) {
    if (candidate == value) return name;
  }
  return {};
}

/// Returns all names of an enumeration, separated by commas.
template <NamedEnum Enum>
std::string names_of() {
  return join(EnumNames<Enum>::names, [](const auto& entry) { return std::string_view(entry.second); });
}

/// Returns the value of that name. Throws InvalidArgument if there is none; the message suggests the nearest
/// name or lists all names.
template <NamedEnum Enum>
Enum parse(std::string_view text) {
  for (const auto& [value, name] : EnumNames<Enum>::names) {
    if (text == name) return value;
  }
  std::vector<std::string> names;
  names.reserve(std::size(EnumNames<Enum>::names));
  for (const auto& [value, name] : EnumNames<Enum>::names) names.emplace_back(name);
  throw InvalidArgument(unknown_in_words(EnumNames<Enum>::kind, std::string(text), names));
}

}  // namespace meshorder
