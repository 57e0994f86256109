// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/deck/lines.hpp"
#include "io/nastran/card.hpp"
#include <meshorder/error.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::nastran {

/// Reads a file of Nastran as one text, with included files in place, and finds the bulk data in it. In lines
/// of bulk data that have no comma, tabs become blanks up to the next multiple of 8 columns.
class DeckText {
 public:
  explicit DeckText(const FilePath& path);

  /// Returns all lines, each with a line end. The caller may move the text out.
  [[nodiscard]] std::string& text() { return text_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Returns the lines between BEGIN BULK and ENDDATA; all lines up to ENDDATA if there is no BEGIN BULK.
  [[nodiscard]] Piece bulk() const { return bulk_; }
  /// Returns false for a file with BEGIN BULK, but without ENDDATA.
  [[nodiscard]] bool has_end() const { return section_ == DeckSection::end || bulk_.begin == 0; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& line_end() const { return lines_.line_end(); }
  [[nodiscard]] const std::vector<std::string>& included() const { return lines_.included(); }

  /// Throws InputError that names the file and line of that byte of the text.
  [[noreturn]] void fail(std::size_t byte, const std::string& what, const std::string& remedy) const;
  /// Returns the file and line of that byte. O(bytes since the byte of the last call) time; O(bytes of the
  /// file) if the last call had a later byte.
  [[nodiscard]] Location location(std::size_t byte) const;

 private:
  /// Consecutive lines of one file.
  struct Origin {
    std::size_t begin;  // first byte in the text
    std::string file;
    std::int64_t line;
  };
  enum class DeckSection : std::uint8_t { control, bulk, end };

  void read();
  bool take_plain_lines();
  void take_line(std::string_view line);
  void include();
  std::string quoted_name(std::string_view line);

  std::string path_;
  DeckLines lines_;
  DeckSection section_ = DeckSection::bulk;
  std::string text_;
  Piece bulk_;
  std::vector<Origin> origins_;
  /// The byte and line of the last call of `location`; npos before the first.
  struct Counted {
    std::size_t byte = std::string::npos;
    std::int64_t line = 0;
  };
  mutable Counted counted_;
  const Scanner* file_ = nullptr;  // file of the last line
};

}  // namespace meshorder::nastran
