// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "io/stream/scanner.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The lines of a deck and, in place, of the files that it includes.
class DeckLines {
 public:
  explicit DeckLines(const FilePath& path);

  /// Gives the next line without its end and blanks around it, and does not take it; returns false at the end
  /// of the deck. The line is valid until the next call.
  bool peek(std::string_view& line);
  /// Takes the line and returns it with its end, which the last line of the deck may lack. Valid until the
  /// next call.
  std::string_view take();
  /// Returns what is left of the present file, from the next line on. Valid until the next call.
  [[nodiscard]] std::string_view rest() { return at().all().substr(static_cast<std::size_t>(at().byte())); }
  /// Goes on with the lines of a file that the deck may include. Fails, at that line of the present file, for
  /// others, for one that does not exist or includes itself, and for too many.
  void include(const std::string& name, std::int64_t line);

  /// Throws InputError at that line of the present file.
  [[noreturn]] void fail(std::int64_t line, const std::string& what, const std::string& remedy) const;
  /// Returns the scanner whose position errors report.
  [[nodiscard]] Scanner& at() { return *files_.back().scanner; }
  /// Returns the end of the deck's lines.
  [[nodiscard]] const std::string& line_end() const noexcept { return line_end_; }
  /// Returns the names of the files included so far.
  [[nodiscard]] const std::vector<std::string>& included() const noexcept { return included_; }

 private:
  struct OpenFile {
    FilePath path;
    std::unique_ptr<Scanner> scanner;
  };

  FilePath main_;
  std::vector<OpenFile> files_;
  std::string line_end_;
  std::string last_line_;  // of an included file, with an end
  std::vector<std::string> included_;
};

}  // namespace meshorder
