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

/// Reads the lines of a deck. The lines of an included file replace the line that includes it.
class DeckLines {
 public:
  explicit DeckLines(const FilePath& path);

  /// Gives the next line, without its end and the blanks around it, but does not take it. Returns false at
  /// the end of the deck. The line is valid until the next call.
  bool peek(std::string_view& line);
  /// Takes the next line and returns it with its end; only the last line of the deck may lack an end. Valid
  /// until the next call.
  std::string_view take();
  /// Estimates how many of the next lines of the present file `take_regular` may take, at most 262,144.
  /// Returns 0 where parallel reading would not pay, such as shortly before a `*` or after an irregular line.
  /// Amortised O(1) for each line.
  Index lines_to_take();
  /// Takes the next nonblank lines of the present file on all threads, up to the first irregular line. The
  /// caller then reads on line by line.
  ///
  /// @param most   as `lines_to_take` returned, > 0
  /// @param parse  `parse(line, number, k)` parses the k-th of these lines. `line` comes without its end and
  ///               leading blanks; `number` is its number in the file. Returns false for an irregular line;
  ///               an error means the same. May be called several times for one k, in any order, on any
  ///               thread
  /// @return the number of lines taken, at most `most`
  Index take_regular(Index most, const std::function<bool(std::string_view, std::int64_t, Index)>& parse);
  /// Returns the rest of the present file, from the next line on. Valid until the next call.
  [[nodiscard]] std::string_view rest() { return at().all().substr(static_cast<std::size_t>(at().byte())); }
  /// Moves on within the present file by whole lines, which the caller has taken from `rest`. O(1).
  void move_on(std::size_t bytes, std::int64_t lines) {
    at().move_to(at().at(at().byte() + static_cast<std::int64_t>(bytes), at().line() + lines));
  }
  /// Continues with the lines of the file `name`. Fails, with `line` of the present file as the place, if the
  /// deck may not include that file, if it does not exist or includes itself, or if there are too many files.
  void include(const std::string& name, std::int64_t line);

  /// Throws InputError at that line of the present file.
  [[noreturn]] void fail(std::int64_t line, const std::string& what, const std::string& remedy) const;
  /// Returns the scanner of the present file; errors report its position.
  [[nodiscard]] Scanner& at() { return *files_.back().scanner; }
  /// Returns the line end that the deck uses: "\n", "\r\n" or "\r".
  [[nodiscard]] const std::string& line_end() const noexcept { return line_end_; }
  /// Returns the names of the files included so far.
  [[nodiscard]] const std::vector<std::string>& included() const noexcept { return included_; }

 private:
  static constexpr Index kMostLines = Index{1} << 18;

  struct OpenFile {
    explicit OpenFile(const FilePath& file) : path(file), scanner(std::make_unique<Scanner>(file)) {}

    FilePath path;
    std::unique_ptr<Scanner> scanner;
    std::int64_t next_try = 0;         ///< `lines_to_take` returns 0 before this byte
    Index lines_at_once = kMostLines;  ///< halved after an irregular line, else doubled again
  };

  FilePath main_;
  std::vector<OpenFile> files_;
  std::string line_end_;
  std::string last_line_;  // last line of an included file, with the line end that it lacked
  std::vector<std::string> included_;
};

}  // namespace meshorder
