// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "lab/report/tables/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace meshorder {
namespace {

/// Returns text as a field of a CSV file.
std::string csv_escaped(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

/// Returns whether the table has rows and each cell of the column is a number or weak.
bool has_numbers(const Table& table, std::size_t column) {
  return !table.rows.empty() && std::all_of(table.rows.begin(), table.rows.end(), [column](const auto& row) {
    return row[column].value || row[column].weak;
  });
}

std::string_view words_of(Certainty certainty) {
  switch (certainty) {
    case Certainty::saves:
      return "saves";
    case Certainty::open:
      return "not told apart";
    case Certainty::costs:
      return "costs";
    case Certainty::unsaid:
      break;
  }
  return {};
}

/// Returns the class of a certainty in the page's style sheet.
std::string_view class_of(Certainty certainty) {
  return certainty == Certainty::open ? std::string_view("open") : words_of(certainty);
}

/// Returns all parts of a cell in one line: "+11.9 (+10.2 … +13.5), saves".
std::string line_of(const TableCell& cell) {
  std::string line = cell.text;
  if (!cell.interval.empty()) line += fmt::format(" ({})", cell.interval);
  if (cell.certainty != Certainty::unsaid) line += fmt::format(", {}", words_of(cell.certainty));
  return line;
}

/// Returns the content of a cell as HTML, its parts in elements of their own.
std::string cell_html(const TableCell& cell) {
  std::string html = xml_escaped(cell.text);
  if (!cell.interval.empty())
    html += fmt::format(" <span class=\"interval\">({})</span>", xml_escaped(cell.interval));
  if (cell.certainty != Certainty::unsaid)
    html += fmt::format(" <span class=\"verdict\">{}</span>", words_of(cell.certainty));
  return html;
}

/// Returns the number of characters of UTF-8 text, which is its width in a terminal.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - std::min(width, width_of(text)), ' ');
  return right ? blanks + text : text + blanks;
}

/// Calls `plain(part)` and `code(part)` for the parts outside and inside backticks. An unpaired last backtick
/// is plain.
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

std::string markdown_escaped(std::string_view text) {
  constexpr std::string_view kMarkup = "\\`*_[]<>|#~&";
  std::string result;
  for (const char c : visible(text, "\n\r\t")) {
    if (kMarkup.find(c) != std::string_view::npos) result += '\\';
    result += c == '\n' || c == '\r' || c == '\t' ? ' ' : c;
  }
  return result;
}

std::string to_markdown(const std::vector<Table>& tables) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Table& table : tables) {
    fmt::format_to(out, "{}## {}\n\n", text.empty() ? "" : "\n", markdown_escaped(table.title));
    if (!table.caption.empty()) fmt::format_to(out, "{}\n\n", markdown_escaped(table.caption));
    for (const std::string& column : table.columns) fmt::format_to(out, "| {} ", markdown_escaped(column));
    text += "|\n";
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      text += has_numbers(table, c) ? "| ---: " : "| --- ";
    text += "|\n";
    for (const auto& row : table.rows) {
      for (const TableCell& cell : row) fmt::format_to(out, "| {} ", markdown_escaped(line_of(cell)));
      text += "|\n";
    }
  }
  return text;
}

std::string to_csv(const std::vector<Table>& tables) {
  std::string text = "table,row,column,text,value\r\n";
  const auto out = std::back_inserter(text);
  for (const Table& table : tables) {
    for (const auto& row : table.rows) {
      for (std::size_t c = 1; c < row.size(); ++c) {
        fmt::format_to(out, "{},{},{},{},{}\r\n", csv_escaped(table.id), csv_escaped(row.front().text),
                       csv_escaped(table.columns[c]), csv_escaped(line_of(row[c])),
                       row[c].value ? fmt::format("{}", *row[c].value) : "");
      }
    }
  }
  return text;
}

std::string to_html(const Table& table) {
  std::string text = fmt::format("<table id=\"{}\">\n", xml_escaped(table.id));
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "<caption><strong>{}</strong> {}</caption>\n<thead><tr>", xml_escaped(table.title),
                 xml_escaped(table.caption));
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    fmt::format_to(out, "<th scope=\"col\"{}>{}</th>", has_numbers(table, c) ? " class=\"number\"" : "",
                   xml_escaped(table.columns[c]));
  }
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const TableCell& cell = row[c];
      const std::string_view element = c == 0 ? "th" : "td";
      std::string classes = has_numbers(table, c) ? "number" : "";
      const auto add_class = [&](std::string_view name) {
        if (!classes.empty()) classes += ' ';
        classes += name;
      };
      if (cell.weak) add_class("weak");
      if (cell.certainty != Certainty::unsaid) add_class(class_of(cell.certainty));
      fmt::format_to(out, "<{}{}", element, c == 0 ? " scope=\"row\"" : "");
      if (!classes.empty()) fmt::format_to(out, " class=\"{}\"", classes);
      if (cell.value) fmt::format_to(out, " data-value=\"{}\"", *cell.value);
      fmt::format_to(out, ">{}</{}>", cell_html(cell), element);
    }
    text += "</tr>\n";
  }
  return text + "</tbody>\n</table>\n";
}

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(width_of(table.columns[c]));
    for (const auto& row : table.rows) widths[c] = std::max(widths[c], width_of(line_of(row[c])));
  }
  std::string text = table.title + "\n";
  const auto add_line = [&](const auto& cell_at) {
    std::string line;
    for (std::size_t c = 0; c < widths.size(); ++c)
      line += (c == 0 ? "" : "  ") + padded(cell_at(c), widths[c], has_numbers(table, c));
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  };
  add_line([&](std::size_t c) { return table.columns[c]; });
  for (const auto& row : table.rows) add_line([&](std::size_t c) { return line_of(row[c]); });
  if (!table.caption.empty()) text += table.caption + "\n";
  return text;
}

std::string prose_as_html(std::string text) {
  constexpr std::string_view kSpaced = " %", kJoined = "\u00a0%";
  for (auto at = text.find(kSpaced); at != std::string::npos; at = text.find(kSpaced, at))
    text.replace(at, kSpaced.size(), kJoined);
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
