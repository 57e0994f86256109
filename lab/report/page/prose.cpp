// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/prose.hpp"

#include "base/text.hpp"
#include "lab/report/tables/tables.hpp"

#include <cstddef>

namespace meshorder {
namespace {

/// Calls `plain(part)` and `code(part)` for the parts outside and inside backticks. The last backtick is
/// plain where it has no partner.
template <class Plain, class Code>
void for_each_part(std::string_view text, Plain plain, Code code) {
  for (;;) {
    const std::size_t begin = text.find('`');
    const std::size_t end = begin == std::string_view::npos ? begin : text.find('`', begin + 1);
    if (end == std::string_view::npos) return plain(text);
    plain(text.substr(0, begin));
    code(text.substr(begin + 1, end - begin - 1));
    text.remove_prefix(end + 1);
  }
}

}  // namespace

std::string prose_as_html(std::string text) {
  constexpr std::string_view kApart = " %", kTogether = "\u00a0%";
  for (auto at = text.find(kApart); at != std::string::npos; at = text.find(kApart, at))
    text.replace(at, kApart.size(), kTogether);
  std::string html;
  for_each_part(
      text, [&](std::string_view part) { html += xml_escaped(part); },
      [&](std::string_view part) { html += "<code>" + xml_escaped(part) + "</code>"; });
  return html;
}

std::string prose_as_markdown(std::string_view text) {
  std::string markdown;
  for_each_part(
      text, [&](std::string_view part) { markdown += markdown_escaped(part); },
      [&](std::string_view part) { markdown += "`" + visible(part) + "`"; });
  return markdown;
}

}  // namespace meshorder
