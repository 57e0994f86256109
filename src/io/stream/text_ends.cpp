// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/text_ends.hpp"

#include "base/text.hpp"

namespace meshorder {
namespace {

constexpr std::string_view kLineEnds = "\r\n";
constexpr std::string_view kAfterText("\0\x1A \t\f\v\r\n", 8);

/// Returns the first position ≥ `from` of a byte that is neither blank nor line end; else the size of the
/// text.
std::size_t first_mark(std::string_view text, std::size_t from) {
  while (from < text.size() &&
         (is_blank(text[from]) || kLineEnds.find(text[from]) != std::string_view::npos)) {
    ++from;
  }
  return from;
}

/// Returns the beginning of the line after the line of byte `from`.
std::size_t next_line(std::string_view text, std::size_t from) {
  const std::size_t end = text.find_first_of(kLineEnds, from);
  if (end == std::string_view::npos) return text.size();
  return end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
}

/// Returns the beginning of the line of byte `at`.
std::size_t line_begin(std::string_view text, std::size_t at) {
  const std::size_t end = at == 0 ? std::string_view::npos : text.find_last_of(kLineEnds, at - 1);
  return end == std::string_view::npos ? 0 : end + 1;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(text.starts_with(kMark) ? kMark.size() : 0);
}

std::string_view without_padding(std::string_view text) {
  constexpr std::string_view kPadding("\0\x1A", 2);
  const std::size_t end = text.find_last_not_of(kAfterText) + 1;  // 0 if there is no other byte
  const std::string_view content = text.substr(0, text.find_first_of(kPadding, end));
  return content.find('\0') == std::string_view::npos ? content : text;
}

bool is_padding(std::string_view text) {
  return text.find_first_not_of(kAfterText) == std::string_view::npos;
}

std::string comments_before(std::string_view text, char comment) {
  std::size_t end = 0;
  for (std::size_t at = first_mark(text, 0); at < text.size() && text[at] == comment;
       at = first_mark(text, end)) {
    end = next_line(text, at);
  }
  return std::string(text.substr(0, end));
}

std::string comments_after(std::string_view text, char comment) {
  // steps back over lines that are blank or comments
  std::size_t begin = text.size();
  std::size_t end = text.size();
  while (end > 0) {
    const std::size_t line = line_begin(text, end - 1);
    const std::size_t mark = first_mark(text.substr(0, end), line);
    if (mark < end && text[mark] != comment) break;
    if (mark < end) begin = line;
    end = line;
  }
  return std::string(text.substr(begin));
}

void note_missing_line_end(const Scanner& scanner, char comment, Notes& notes) {
  const std::string_view text = scanner.all();
  const std::size_t line = line_begin(text, text.size());
  if (line == text.size() || text.substr(line).find(comment) != std::string_view::npos) return;
  notes.push_back(scanner.file() + " has no final newline: its last number may be cut short");
}

}  // namespace meshorder
