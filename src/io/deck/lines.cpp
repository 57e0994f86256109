// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/deck/lines.hpp"

#include "base/text.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/regular_text.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace meshorder {
namespace {

constexpr std::size_t kMostFiles = 10000;
constexpr std::size_t kMostNested = 16;
constexpr std::size_t kLineBytes = 64;  // assumed length of a line, to estimate how many lines follow

}  // namespace

DeckLines::DeckLines(const FilePath& path) : main_(path) {
  files_.emplace_back(path);
  const std::string_view text = at().all();
  const std::size_t end = text.find_first_of("\r\n");
  const bool is_pair = end != std::string_view::npos && text.substr(end, 2) == "\r\n";
  line_end_ = is_pair ? "\r\n" : end != std::string_view::npos && text[end] == '\r' ? "\r" : "\n";
}

bool DeckLines::peek(std::string_view& line) {
  while (at().bytes_left() == 0) {
    if (files_.size() == 1) return false;
    files_.pop_back();
  }
  line = trimmed(at().peek_line());
  return true;
}

std::string_view DeckLines::take() {
  Scanner& file = at();
  const auto begin = static_cast<std::size_t>(file.byte());
  (void)file.raw_line();
  const std::string_view line = file.all().substr(begin, static_cast<std::size_t>(file.byte()) - begin);
  const bool has_end = line.ends_with('\n') || line.ends_with('\r');
  if (has_end || files_.size() == 1) return line;
  last_line_ = std::string(line) + line_end_;
  return last_line_;
}

Index DeckLines::lines_to_take() {
  constexpr std::size_t kFewBytes = std::size_t{1} << 17;
  OpenFile& file = files_.back();
  const std::int64_t byte = file.scanner->byte();
  if (byte < file.next_try) return 0;
  const std::string_view ahead = rest().substr(0, kLineBytes * static_cast<std::size_t>(file.lines_at_once));
  const std::size_t bytes = std::min(ahead.size(), ahead.find('*'));
  if (bytes < kFewBytes) {
    file.next_try = byte + static_cast<std::int64_t>(bytes);
    return 0;
  }
  return static_cast<Index>(bytes / kLineBytes);
}

Index DeckLines::take_regular(Index most,
                              const std::function<bool(std::string_view, std::int64_t, Index)>& parse) {
  constexpr std::size_t kPartBytes = std::size_t{1} << 20;
  OpenFile& file = files_.back();
  const auto read = [&](Scanner& at, Index k) {
    // lines end in LF or CR LF here: a text with lines that end in CR alone is read on one thread
    const std::string_view rest = at.all().substr(static_cast<std::size_t>(at.byte()));
    std::string_view line = rest.substr(0, rest.find('\n'));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!parse(line, at.line(), k)) return false;
    at.move_on(line.size());
    return true;
  };
  const Index taken = read_regular_records(*file.scanner, most, read, kPartBytes);
  if (taken < most) {
    file.next_try = file.scanner->byte() + static_cast<std::int64_t>(kPartBytes);
    file.lines_at_once = std::max(file.lines_at_once / 2, static_cast<Index>(kPartBytes / kLineBytes));
  } else {
    file.lines_at_once = std::min(2 * file.lines_at_once, kMostLines);
  }
  return taken;
}

void DeckLines::fail(std::int64_t line, const std::string& what, const std::string& remedy) const {
  throw InputError(Location{files_.back().scanner->file(), line, -1}, what, remedy);
}

void DeckLines::include(const std::string& name, std::int64_t line) {
  const auto refuse = [&](std::string_view fault, const std::string& remedy) {
    fail(line, fmt::format("the included file '{}' {}", shown(name), fault), remedy);
  };
  const FilePath path = main_.beside(name);
  if (!may_include(main_, path)) refuse("is not in the deck's folder", kIncludeRemedy);
  if (!path.is_file()) refuse("does not exist", "put it into the deck's folder");
  const bool circular = std::any_of(files_.begin(), files_.end(),
                                    [&](const OpenFile& file) { return file.path.is_same(path); });
  if (circular) refuse("includes itself", "remove the circle");
  if (included_.size() == kMostFiles) fail(line, "more than 10000 files are included", "join them");
  if (files_.size() > kMostNested) fail(line, "files are included more than 16 deep", "join some of them");
  included_.push_back(name);
  if (!path.is_empty()) files_.emplace_back(path);
}

}  // namespace meshorder
