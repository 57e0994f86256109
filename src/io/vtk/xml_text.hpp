// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meshorder {

/// `text` as it stands in an XML attribute between double quotes.
inline std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
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
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace meshorder
