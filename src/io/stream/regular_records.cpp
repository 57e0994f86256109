// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "base/text.hpp"
#include "io/stream/regular_text.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace meshorder {
namespace {

constexpr std::size_t kPartsAtOnce = 64;
constexpr std::size_t kLineBytes = 64;  // assumed bytes of a line, to choose how much text to examine

/// Some whole lines of a text.
struct TextPart {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::int64_t lines = 0;
  std::int64_t record_lines = 0;
  bool has_other_ends = false;  ///< has lines that end in CR alone; `lines` does not count them

  // set after the lines of all parts are counted
  std::int64_t first_line = 0;
  std::int64_t record_lines_before = 0;  ///< number of lines of records before this part
  bool is_regular = false;
};

/// The form of a text's records, and the function that reads one.
struct Records {
  const std::function<bool(Scanner&, Index)>& read;
  Index lines = 1;            ///< number of lines of each record
  bool may_be_blank = false;  ///< lines without words belong to records too

  /// Returns how many records begin in the first `record_lines` lines of records.
  [[nodiscard]] std::int64_t begin_in(std::int64_t record_lines) const {
    return (record_lines + lines - 1) / lines;
  }
};

/// Counts a part's lines, and separately its lines of records, as a Scanner does.
void count_lines(std::string_view text, char comment, const Records& records, TextPart& part) {
  const std::string_view whole = text.substr(part.begin, part.end - part.begin);
  const bool has_returns = whole.find('\r') != std::string_view::npos;
  for (std::size_t at = 0; at < whole.size();) {
    const void* const found = std::memchr(whole.data() + at, '\n', whole.size() - at);
    const std::size_t end = found == nullptr
                                ? whole.size()
                                : static_cast<std::size_t>(static_cast<const char*>(found) - whole.data());
    std::string_view line = whole.substr(at, end - at);
    if (found != nullptr) ++part.lines;
    if (found != nullptr && line.ends_with('\r')) line.remove_suffix(1);
    if (has_returns && line.find('\r') != std::string_view::npos) part.has_other_ends = true;
    if (!records.may_be_blank) line = trimmed(line);
    const bool is_comment = comment != '\0' && line.starts_with(comment);
    if (!is_comment && (records.may_be_blank || !line.empty())) ++part.record_lines;
    at = end + 1;
  }
}

/// Divides the text from `begin` on into parts, up to the estimated end of `lines` lines. Without the
/// estimate, even a short run of records would cost a pass over the rest of the text.
std::vector<TextPart> divided(std::string_view text, std::size_t begin, std::size_t bytes,
                              std::size_t lines) {
  std::vector<TextPart> parts;
  const std::size_t last = std::min(text.size(), begin + lines * kLineBytes);
  while (parts.size() < kPartsAtOnce && begin < last) {
    std::size_t end = std::min(begin + bytes, last);
    end = std::min(text.find('\n', end - 1), text.size() - 1) + 1;
    parts.push_back({.begin = begin, .end = end});
    begin = end;
  }
  return parts;
}

/// Reads the records from `record` to `last` − 1, up to the first irregular one. Returns the number of the
/// first record that was not read, and moves `in` after the last record read.
std::int64_t read_one_by_one(Scanner& in, std::int64_t record, std::int64_t last, const Records& records) {
  Scanner at = in;
  try {
    for (; record < last; ++record) {
      poll_in_loop(record);
      if (records.may_be_blank ? at.bytes_left() == 0 : at.at_end()) break;
      const std::int64_t last_line = at.line() + records.lines - 1;
      if (!records.read(at, static_cast<Index>(record)) || at.line() != last_line || !at.at_line_end()) break;
      if (records.may_be_blank) (void)at.raw_line();
      in.move_to(at);
    }
  } catch (const InputError&) {  // the caller reads the record again and gets the error
  }
  return record;
}

/// Reads the records below number `count` that begin in a part; moves `at` after them.
void read_records_of(Scanner& at, Index count, const Records& records, TextPart& part) {
  if (part.has_other_ends) return;
  const std::int64_t first = records.begin_in(part.record_lines_before);
  const std::int64_t last =
      std::min<std::int64_t>(count, records.begin_in(part.record_lines_before + part.record_lines));
  at = at.at(static_cast<std::int64_t>(part.begin), part.first_line);
  for (std::int64_t line = part.record_lines_before; line < first * records.lines; ++line) {
    (void)at.at_end();
    (void)at.raw_line();
  }
  if (read_one_by_one(at, first, last, records) < last) return;
  part.is_regular = true;
  const auto end = static_cast<std::int64_t>(part.end);
  if (last == count || at.byte() >= end) return;
  (void)at.at_end();  // skips the comments after the last record
  at = at.at(end, part.first_line + part.lines);
}

Index read_lines(Scanner& in, Index count, const Records& records, std::size_t part_bytes) {
  if (thread_count() == 1) {  // one thread need not count lines first
    return static_cast<Index>(read_one_by_one(in, 0, count, records));
  }
  const std::string_view text = in.all();
  std::int64_t done = 0;
  while (done < count) {
    std::vector<TextPart> parts = divided(text, static_cast<std::size_t>(in.byte()), part_bytes,
                                          static_cast<std::size_t>((count - done) * records.lines));
    for_each_chunk(index_size(parts), 1, [&](Index k, Index, Index) {
      count_lines(text, in.comment(), records, parts[static_cast<std::size_t>(k)]);
    });
    std::int64_t line = in.line();
    std::int64_t record_lines = done * records.lines;
    for (TextPart& part : parts) {
      part.first_line = line;
      part.record_lines_before = record_lines;
      line += part.lines;
      record_lines += part.record_lines;
    }
    std::vector<Scanner> ends(parts.size(), in);
    for_each_chunk(index_size(parts), 1, [&](Index k, Index, Index) {
      read_records_of(ends[static_cast<std::size_t>(k)], count, records, parts[static_cast<std::size_t>(k)]);
    });
    const std::int64_t before = done;
    for (std::size_t k = 0; k < parts.size() && done < count; ++k) {
      if (!parts[k].is_regular) return static_cast<Index>(done);
      const std::int64_t after = parts[k].record_lines_before + parts[k].record_lines;
      done = std::min<std::int64_t>(count, records.begin_in(after));
      in.move_to(ends[k]);
    }
    if (done == before) break;  // nothing is left
  }
  return static_cast<Index>(done);
}

}  // namespace

Index read_regular_records(Scanner& in, Index count, const std::function<bool(Scanner&, Index)>& read,
                           std::size_t part_bytes, Index lines) {
  return read_lines(in, count, {.read = read, .lines = lines}, part_bytes);
}

Index read_regular_lines(Scanner& in, Index count, const std::function<bool(Scanner&, Index)>& read,
                         std::size_t part_bytes) {
  return read_lines(in, count, {.read = read, .may_be_blank = true}, part_bytes);
}

}  // namespace meshorder
