// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

namespace meshorder {

/// The characters that XML counts as blanks.
inline constexpr std::string_view kXmlBlanks = " \t\r\n";

/// Returns a text without the blanks at its ends.
inline std::string_view without_xml_blanks(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kXmlBlanks), text.size());
  return text.substr(begin, text.find_last_not_of(kXmlBlanks) + 1 - begin);
}

/// Parses a whole number of XML, which may have a + and blanks around it. Returns false for any other text
/// and for numbers outside of the range of `Number`.
template <class Number>
bool parse_xml_number(std::string_view text, Number& number) {
  text = without_xml_blanks(text);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto [after, code] = std::from_chars(text.data(), end, number);
  return code == std::errc{} && after == end;
}

}  // namespace meshorder
