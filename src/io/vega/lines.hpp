// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/scanner.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

/// The lines of a Vega file, with those of the files that it includes in their places, without comments and
/// blank lines.
class VegaLines {
 public:
  explicit VegaLines(const std::filesystem::path& path);

  /// The next line, trimmed and not taken, so that an error still names it; false at the end of all. The
  /// line is valid until the next peek.
  bool peek(std::string_view& line);
  void take() { (void)at().raw_line(); }

  /// Where errors are reported.
  [[nodiscard]] Scanner& at() { return *files_.back().scanner; }

  /// The comments met since the last call, whole lines.
  std::string take_comments() { return std::exchange(comments_, {}); }

  /// The names of the files included so far.
  [[nodiscard]] const std::vector<std::string>& included() const noexcept { return included_; }

 private:
  struct OpenFile {
    std::filesystem::path path;
    std::unique_ptr<Scanner> scanner;
  };

  void open(const std::filesystem::path& path);
  void include(const std::string& name);

  std::filesystem::path folder_;
  std::vector<OpenFile> files_;
  std::string comments_;
  std::vector<std::string> included_;
};

}  // namespace meshorder
