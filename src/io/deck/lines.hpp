// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/scanner.hpp"

#include <cstdint>
#include <functional>
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
  /// Returns how many of the next lines of the present file may be taken by `take_regular`, at most 262,144:
  /// 0 where few come before the next `*`, or where a line was not regular a short while ago. O(1) on
  /// average.
  Index lines_to_take();
  /// Takes the next lines of the present file that have something on them, on all threads, as far as they are
  /// regular. The caller reads the others one after another.
  ///
  /// @param most   as `lines_to_take` returned, > 0
  /// @param parse  `parse(line, number, k)` gets line k of those, without its end and blanks before it, and
  /// its
  ///               number in the file; false: it is not regular. May be called again for k. An error makes a
  ///               line irregular
  /// @return how many, at most `most`
  Index take_regular(Index most, const std::function<bool(std::string_view, std::int64_t, Index)>& parse);
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
  static constexpr Index kMostLines = Index{1} << 18;

  struct OpenFile {
    explicit OpenFile(const FilePath& file);

    FilePath path;
    std::unique_ptr<Scanner> scanner;
    bool has_other_blanks;             ///< form feeds or vertical tabs, which a Scanner skips
    std::int64_t next_try = 0;         ///< byte from which on `take_regular` tries again
    Index lines_at_once = kMostLines;  ///< half as many after each line that is not regular
  };

  FilePath main_;
  std::vector<OpenFile> files_;
  std::string line_end_;
  std::string last_line_;  // of an included file, with an end
  std::vector<std::string> included_;
};

}  // namespace meshorder
