// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "lab/report/tables/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace meshorder {
namespace {

/// As a field of a CSV file.
std::string csv_escaped(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

/// Whether the column's cells are numbers, but for pale ones.
bool has_numbers(const Table& table, std::size_t column) {
  return !table.rows.empty() && std::all_of(table.rows.begin(), table.rows.end(), [column](const auto& row) {
    return row[column].value || row[column].weak;
  });
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
      for (const TableCell& cell : row) fmt::format_to(out, "| {} ", markdown_escaped(cell.text));
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
                       csv_escaped(table.columns[c]), csv_escaped(row[c].text),
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
      if (cell.weak) classes += classes.empty() ? "weak" : " weak";
      fmt::format_to(out, "<{}{}", element, c == 0 ? " scope=\"row\"" : "");
      if (!classes.empty()) fmt::format_to(out, " class=\"{}\"", classes);
      if (cell.value) fmt::format_to(out, " data-value=\"{}\"", *cell.value);
      fmt::format_to(out, ">{}</{}>", xml_escaped(cell.text), element);
    }
    text += "</tr>\n";
  }
  return text + "</tbody>\n</table>\n";
}

}  // namespace meshorder
