// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/nastran/deck_text.hpp"

#include "base/text.hpp"

#include <algorithm>
#include <array>

namespace meshorder::nastran {
namespace {

constexpr std::size_t kTab = 8;

/// Returns whether a line begins with that word, in upper or lower case, and the word ends there.
bool begins_with(std::string_view line, std::string_view word) {
  constexpr int kCase = 'a' - 'A';
  if (line.size() < word.size() || (line.front() | kCase) != (word.front() | kCase)) return false;
  if (!same_but_for_case(line.substr(0, word.size()), word)) return false;
  return line.size() == word.size() || is_blank(line[word.size()]) ||
         std::string_view(",=$'\"").find(line[word.size()]) != std::string_view::npos;
}

/// Returns the word after BEGIN; empty for other lines.
std::string_view word_after_begin(std::string_view line) {
  if (!begins_with(line, "BEGIN")) return {};
  line.remove_prefix(std::string_view("BEGIN").size());
  return next_word(line, "=$");
}

bool begins_bulk(std::string_view line) { return same_but_for_case(word_after_begin(line), "BULK"); }

/// Returns whether a text has the line BEGIN BULK.
bool has_begin_bulk(std::string_view text) {
  constexpr std::array<std::string_view, 3> kSpellings{"BEGIN", "begin", "Begin"};
  for (const std::string_view word : kSpellings) {
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
      const std::size_t line = at == 0 ? 0 : text.find_last_of("\r\n", at - 1) + 1;
      const std::string_view rest = text.substr(at, text.find_first_of("\r\n", at) - at);
      if (trimmed(text.substr(line, at - line)).empty() && begins_bulk(rest)) return true;
    }
  }
  return false;
}

/// Returns true only if a line of bulk data stays unchanged whatever precedes it; may return false even then.
bool is_plain(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.find('\t') != std::string_view::npos || line.find('\r') != std::string_view::npos) return false;
  const std::string_view word = trimmed(line).substr(0, 2);
  if (word.empty()) return true;
  constexpr std::string_view kFirst = "BbEeIi";  // BEGIN, ENDDATA, INCLUDE
  if (word.front() != 'C' && word.front() != 'c') return kFirst.find(word.front()) == std::string_view::npos;
  return word.size() == 2 && word.back() != 'E' && word.back() != 'e';  // not CEND
}

void append_without_tabs(std::string& out, std::string_view line) {
  std::size_t column = 0;
  for (const char c : line) {
    const std::size_t blanks = c == '\t' ? kTab - column % kTab : 0;
    if (c == '\t') {
      out.append(blanks, ' ');
      column += blanks;
    } else {
      out += c;
      ++column;
    }
  }
}

}  // namespace

DeckText::DeckText(const FilePath& path) : path_(path.string()), lines_(path) {
  const std::string_view all = lines_.at().all();
  if (all.find('\0') != std::string_view::npos) {
    throw InputError(path.string(), "is not a text file, unlike bulk data of Nastran", "give its bulk data");
  }
  if (has_begin_bulk(all)) section_ = DeckSection::control;
  text_.reserve(all.size() + 1);
  read();
  if (section_ != DeckSection::end) bulk_.end = text_.size();
}

void DeckText::read() {
  std::string_view line;
  while (lines_.peek(line)) {
    if (&lines_.at() != file_) {
      file_ = &lines_.at();
      origins_.push_back({text_.size(), file_->file(), file_->line()});
    }
    if (section_ == DeckSection::bulk && take_plain_lines()) continue;
    if (section_ != DeckSection::end && begins_with(line, "INCLUDE")) {
      include();
    } else {
      take_line(line);
    }
  }
}

/// Takes the lines up to the next line that is long or not plain, faster than `take_line`; returns false if
/// it takes none. Most lines of a mesh are short and plain.
bool DeckText::take_plain_lines() {
  const std::string_view rest = lines_.rest();
  std::size_t bytes = 0;
  std::int64_t lines = 0;
  constexpr std::size_t kLongest = 256;
  for (;; ++lines) {
    const std::string_view ahead = rest.substr(bytes, kLongest);
    const std::size_t end = ahead.find('\n');
    if (end == std::string_view::npos || !is_plain(ahead.substr(0, end))) break;
    bytes += end + 1;
  }
  text_ += rest.substr(0, bytes);
  lines_.move_on(bytes, lines);
  return lines > 0;
}

/// Takes the next line. `line` is the same line without the blanks around it.
void DeckText::take_line(std::string_view line) {
  const std::size_t begin = text_.size();
  if (section_ == DeckSection::bulk) {
    if (begins_with(line, "ENDDATA")) {
      section_ = DeckSection::end;
      bulk_.end = begin;
    } else if (!word_after_begin(line).empty()) {
      lines_.at().fail("a second section of bulk data begins", "give models without superelements");
    } else if (begins_with(line, "CEND")) {
      lines_.at().fail("no BEGIN BULK after case control", "the file may be cut short");
    }
  }
  const bool starts_bulk = section_ == DeckSection::control && begins_bulk(line);
  const std::string_view content = line.substr(0, line.find('$'));
  const bool is_fixed = !content.empty() && content.find(',') == std::string_view::npos;
  const std::string_view taken = lines_.take();
  if (section_ == DeckSection::bulk && is_fixed && taken.find('\t') != std::string_view::npos) {
    append_without_tabs(text_, taken);
  } else {
    text_ += taken;
  }
  if (text_.back() != '\n' && text_.back() != '\r') text_ += lines_.line_end();
  if (starts_bulk) {
    section_ = DeckSection::bulk;
    bulk_.begin = text_.size();
  }
}

/// Returns a name in quotes, which may extend over several lines; takes all of these lines but the last.
std::string DeckText::quoted_name(std::string_view line) {
  constexpr std::size_t kLongest = 4096;
  const std::int64_t first = lines_.at().line();
  const char quote = line.front();
  std::string name;
  line.remove_prefix(1);
  for (std::size_t end = line.find(quote); end == std::string_view::npos; end = line.find(quote)) {
    name += line;
    const Scanner* const file = &lines_.at();
    (void)lines_.take();
    if (name.size() > kLongest || file->bytes_left() == 0 || !lines_.peek(line)) {
      lines_.fail(first, "the name of the included file has no quote at its end", "add it");
    }
  }
  return name.append(line.substr(0, line.find(quote)));
}

/// Handles INCLUDE 'name': the next lines come from that file.
void DeckText::include() {
  const std::int64_t number = lines_.at().line();
  std::string_view line;
  (void)lines_.peek(line);
  line = trimmed(line.substr(std::string_view("INCLUDE").size()));
  if (line.starts_with('=')) line = trimmed(line.substr(1));
  const bool is_quoted = line.starts_with('\'') || line.starts_with('"');
  std::string name = is_quoted ? quoted_name(line) : std::string(line.substr(0, line.find('$')));
  name.erase(name.find_last_not_of(" \t\f\v") + 1);
  (void)lines_.take();
  if (name.empty()) lines_.fail(number, "the name of a file is missing", "write INCLUDE 'FILE'");
  lines_.include(name, number);
  file_ = nullptr;
}

Location DeckText::location(std::size_t byte) const {
  const auto after = std::upper_bound(origins_.begin(), origins_.end(), byte,
                                      [](std::size_t at, const Origin& origin) { return at < origin.begin; });
  const Origin& origin = *std::prev(after);
  if (counted_.byte < origin.begin || counted_.byte > byte) counted_ = {origin.begin, origin.line};
  for (; counted_.byte < byte; ++counted_.byte) {
    const std::size_t k = counted_.byte;
    const bool is_pair = text_[k] == '\r' && k + 1 < text_.size() && text_[k + 1] == '\n';
    if ((text_[k] == '\n' || text_[k] == '\r') && !is_pair) ++counted_.line;
  }
  return {origin.file, counted_.line, -1};
}

void DeckText::fail(std::size_t byte, const std::string& what, const std::string& remedy) const {
  throw InputError(location(byte), what, remedy);
}

}  // namespace meshorder::nastran
