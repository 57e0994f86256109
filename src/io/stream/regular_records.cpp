// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
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
constexpr std::size_t kRecordBytes = 64;  // for each record left, bytes of text to examine first

/// Some whole lines of a text.
struct TextPart {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::int64_t lines = 0;
  std::int64_t records = 0;
  bool has_other_ends = false;  ///< lines that end in CR alone, which are not counted

  // set when the part has been read
  std::int64_t first_line = 0;
  std::int64_t first_record = 0;
  bool is_regular = false;
};

/// Which lines of a text are records.
enum class RecordLines : std::uint8_t { with_words, all };

/// Counts all lines of a part, and those that are records, as a Scanner does.
void count_lines(std::string_view text, char comment, RecordLines lines, TextPart& part) {
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
    const std::size_t word = lines == RecordLines::all ? 0 : line.find_first_not_of(" \t\f\v");
    const bool is_comment = comment != '\0' && word < line.size() && line[word] == comment;
    if (word != std::string_view::npos && !is_comment) ++part.records;
    at = end + 1;
  }
}

/// Divides the text from `begin` on into parts, up to where that many records usually end. A file may have
/// many short runs of records, and none of them may cost a pass over the rest of the text.
std::vector<TextPart> divided(std::string_view text, std::size_t begin, std::size_t bytes,
                              std::size_t records) {
  std::vector<TextPart> parts;
  const std::size_t last = std::min(text.size(), begin + records * kRecordBytes);
  while (parts.size() < kPartsAtOnce && begin < last) {
    std::size_t end = std::min(begin + bytes, last);
    end = std::min(text.find('\n', end - 1), text.size() - 1) + 1;
    parts.push_back({.begin = begin, .end = end});
    begin = end;
  }
  return parts;
}

/// Reads the records from `record` to `last` − 1, up to the first irregular one, which it returns. `in` is
/// then after the record before that.
std::int64_t read_one_by_one(Scanner& in, std::int64_t record, std::int64_t last, RecordLines lines,
                             const std::function<bool(Scanner&, Index)>& read) {
  Scanner at = in;
  try {
    for (; record < last; ++record) {
      poll_in_loop(record);
      if (lines == RecordLines::all ? at.bytes_left() == 0 : at.at_end()) break;
      const std::int64_t own_line = at.line();
      if (!read(at, static_cast<Index>(record)) || at.line() != own_line || !at.at_line_end()) break;
      if (lines == RecordLines::all) (void)at.raw_line();
      in.move_to(at);
    }
  } catch (const InputError&) {  // the caller finds it again
  }
  return record;
}

Index read_lines(Scanner& in, Index count, RecordLines lines,
                 const std::function<bool(Scanner&, Index)>& read, std::size_t part_bytes) {
  if (thread_count() == 1) {  // lines need not be counted first
    return static_cast<Index>(read_one_by_one(in, 0, count, lines, read));
  }
  const std::string_view text = in.all();
  std::int64_t done = 0;
  while (done < count) {
    std::vector<TextPart> parts = divided(text, static_cast<std::size_t>(in.byte()), part_bytes,
                                          static_cast<std::size_t>(count - done));
    for_each_chunk(index_size(parts), 1, [&](Index k, Index, Index) {
      count_lines(text, in.comment(), lines, parts[static_cast<std::size_t>(k)]);
    });
    std::int64_t line = in.line();
    std::int64_t record = done;
    for (TextPart& part : parts) {
      part.first_line = line;
      part.first_record = record;
      line += part.lines;
      record += part.records;
    }
    std::vector<Scanner> ends(parts.size(), in);
    for_each_chunk(index_size(parts), 1, [&](Index k, Index, Index) {
      TextPart& part = parts[static_cast<std::size_t>(k)];
      if (part.has_other_ends) return;
      Scanner at = in.at(static_cast<std::int64_t>(part.begin), part.first_line);
      const std::int64_t last = std::min<std::int64_t>(count, part.first_record + part.records);
      if (read_one_by_one(at, part.first_record, last, lines, read) < last) return;
      if (last < count) {
        (void)at.at_end();  // skips the comments after the last record
        at = at.at(static_cast<std::int64_t>(part.end), part.first_line + part.lines);
      }
      ends[static_cast<std::size_t>(k)] = at;
      part.is_regular = true;
    });
    const std::int64_t before = done;
    for (std::size_t k = 0; k < parts.size() && done < count; ++k) {
      if (!parts[k].is_regular) return static_cast<Index>(done);
      done = std::min<std::int64_t>(count, done + parts[k].records);
      in.move_to(ends[k]);
    }
    if (done == before) break;  // nothing is left
  }
  return static_cast<Index>(done);
}

}  // namespace

Index read_regular_records(Scanner& in, Index count, const std::function<bool(Scanner&, Index)>& read,
                           std::size_t part_bytes) {
  return read_lines(in, count, RecordLines::with_words, read, part_bytes);
}

Index read_regular_lines(Scanner& in, Index count, const std::function<bool(Scanner&, Index)>& read,
                         std::size_t part_bytes) {
  return read_lines(in, count, RecordLines::all, read, part_bytes);
}

}  // namespace meshorder
