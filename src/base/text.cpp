// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace meshorder {
namespace {

/// The character at the front of a text.
struct Utf8Character {
  std::uint32_t code = 0;  ///< the byte where it is no UTF-8
  std::size_t bytes = 1;
  bool is_valid = true;
};

/// Decodes the first character of a text that is not empty. Overlong forms, surrogates and numbers above
/// 0x10FFFF are no UTF-8.
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

/// Appends "\\u202e" for a character below 0x10000, "\\xff" for a byte that is no UTF-8.
void append_escape(const Utf8Character& character, std::string& text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  text += character.is_valid ? "\\u" : "\\x";
  for (int shift = character.is_valid ? 12 : 4; shift >= 0; shift -= 4)
    text += kDigits[character.code >> static_cast<unsigned>(shift) & 0xFU];
}

/// Returns `text` with escapes in place of bytes that are no UTF-8 and of characters for which `is_plain` is
/// false.
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
        // readers replace these by blanks in an attribute unless they are escaped
        result += "&#" + std::to_string(static_cast<int>(c)) + ";";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace meshorder
