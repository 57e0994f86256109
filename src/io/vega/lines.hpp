// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "io/stream/scanner.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

/// The lines of a Vega file and, in place, of the files that it includes, without comments and blank lines.
class VegaLines {
 public:
  explicit VegaLines(const FilePath& path);

  /// Sets `line` to the next line, trimmed, without taking it; returns false at the end. The line is valid
  /// until the next peek.
  bool peek(std::string_view& line);
  void take() { (void)at().raw_line(); }

  /// The scanner whose position errors report.
  [[nodiscard]] Scanner& at() { return *files_.back().scanner; }

  /// Returns the comments since the last call, whole lines.
  std::string take_comments() { return std::exchange(comments_, {}); }

  /// Returns the names of the files included so far.
  [[nodiscard]] const std::vector<std::string>& included() const noexcept { return included_; }

 private:
  struct OpenFile {
    FilePath path;
    std::unique_ptr<Scanner> scanner;
  };

  void open(const FilePath& path);
  void include(const std::string& name);

  FilePath main_;
  std::vector<OpenFile> files_;
  std::string comments_;
  std::vector<std::string> included_;
};

}  // namespace meshorder
