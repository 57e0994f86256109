// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"

#include <cstdint>
#include <numeric>

namespace meshorder {

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](char c) { return lower_case(c); });
  return result;
}

std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = 'a' <= c && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return result;
}

namespace {

/// A character decoded from a text.
struct Utf8Character {
  std::uint32_t code = 0;  ///< the byte itself if it is not valid UTF-8
  std::size_t bytes = 1;
  bool is_valid = true;
};

/// Decodes the first character of a text that is not empty. Overlong forms, surrogates and numbers above
/// 0x10FFFF are invalid.
Utf8Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {first};
  const std::size_t bytes = first < 0xC2 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 1;
  const Utf8Character invalid{first, 1, false};
  if (bytes == 1 || text.size() < bytes) return invalid;
  std::uint32_t code = first & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return invalid;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool overlong = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  if (overlong || surrogate || code > 0x10FFFF) return invalid;
  return {code, bytes};
}

bool turns_direction(std::uint32_t code) {
  return code == 0x61C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

/// Appends "\u202e" for a character below 0x10000, "\xff" for a byte that is not valid UTF-8.
void append_escape(const Utf8Character& character, std::string& text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  text += character.is_valid ? "\\u" : "\\x";
  for (int shift = character.is_valid ? 12 : 4; shift >= 0; shift -= 4)
    text += kDigits[character.code >> static_cast<unsigned>(shift) & 0xFU];
}

/// Returns `text` with escapes in place of bytes that are not valid UTF-8 and of characters for which
/// `is_plain` is false.
template <class IsPlain>
std::string with_escapes(std::string_view text, IsPlain is_plain) {
  std::string result;
  while (!text.empty()) {
    const Utf8Character character = first_character(text);
    if (character.is_valid && is_plain(character.code)) {
      result += text.substr(0, character.bytes);
    } else {
      append_escape(character, result);
    }
    text.remove_prefix(character.bytes);
  }
  return result;
}

/// Returns the word in lower case, without leading dashes.
std::string bare(std::string_view word) {
  return lower_case(word.substr(std::min(word.find_first_not_of('-'), word.size())));
}

/// Returns the least number of insertions, deletions, replacements and exchanges of adjacent letters that
/// turn one word into the other (Damerau and Levenshtein; no letter is changed twice).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> rows(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) rows[i][0] = i;
  std::iota(rows[0].begin(), rows[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = rows[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      rows[i][j] = std::min({replaced, rows[i][j - 1] + 1, rows[i - 1][j] + 1});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
    }
  }
  return rows[a.size()][b.size()];
}

/// Returns whether the words begin with the same letters: three or more, and all but at most two of `word`.
bool begin_alike(const std::string& word, const std::string& name) {
  constexpr std::size_t kShortestBeginning = 3;
  const auto differ = std::mismatch(word.begin(), word.end(), name.begin(), name.end()).first;
  const auto same = static_cast<std::size_t>(differ - word.begin());
  return same >= kShortestBeginning && same + 2 >= word.size();
}

}  // namespace

std::string visible(std::string_view text, std::string_view kept) {
  return with_escapes(text, [kept](std::uint32_t code) {
    if (code < 0x20) return kept.find(static_cast<char>(code)) != std::string_view::npos;
    return (code < 0x7F || code > 0x9F) && !turns_direction(code);
  });
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const Utf8Character character = first_character(text);
    if (!character.is_valid) return false;
    text.remove_prefix(character.bytes);
  }
  return true;
}

std::string_view utf8_prefix(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most;
  const auto follows = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  while (end > 0 && most - end < 3 && follows(end)) --end;
  return text.substr(0, follows(end) ? most : end);
}

std::string xml_text(std::string_view text) {
  return with_escapes(text, [](std::uint32_t code) {
    if (code < 0x20) return code == '\t' || code == '\n' || code == '\r';
    return code != 0xFFFE && code != 0xFFFF;
  });
}

std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char c : xml_text(text)) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\t':
      case '\n':
      case '\r':
        // XML readers replace unescaped tabs and line ends in an attribute by blanks
        result += "&#" + std::to_string(static_cast<int>(c)) + ";";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  const std::string letters = bare(word);
  std::size_t least = std::min<std::size_t>(2, (letters.size() + 1) / 3) + 1;
  std::string nearest;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(letters, bare(name));
    if (distance < least) {
      least = distance;
      nearest = name;
    } else if (nearest.empty() && begin_alike(letters, bare(name))) {
      nearest = name;
    }
  }
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

std::string unknown_in_words(std::string_view kind, const std::string& word,
                             const std::vector<std::string>& names) {
  const std::string nearest = suggestion(word, names);
  return "unknown " + std::string(kind) + " '" + word + "'" +
         (nearest.empty() ? "; known: " + join(names) : nearest);
}

}  // namespace meshorder
