// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/mesh.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace meshorder::openfoam {

/// A file of OpenFOAM, read from front to back: a header `FoamFile { … }`, then lists of numbers, as text or
/// as binary numbers between parentheses. Comments are C++'s. Errors name the line in a text file, the byte
/// in a binary file.
///
/// A list is "3(0 1 2)", in text also "3{7}" for three times 7. Sizes are checked before memory is allocated
/// for them.
class FoamFile {
 public:
  /// Reads the file at `path`, or at `path` with ".gz", and its header.
  ///
  /// @throws InputError for a file that is missing, unreadable or without a header
  explicit FoamFile(const FilePath& path);

  /// Returns whether there is a file at `path`, or at `path` with ".gz".
  [[nodiscard]] static bool exists(const FilePath& path);

  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  /// Returns the value of `class` in the header; empty if there is none.
  [[nodiscard]] const std::string& class_name() const noexcept { return class_; }

  /// Returns the value of `note` in the header; empty if there is none.
  [[nodiscard]] const std::string& note() const noexcept { return note_; }
  /// Throws an InputError with the line of `class` in the header if `class` has another value.
  void require_class(std::string_view class_name) const;

  /// Throws an InputError at the current line or byte.
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;

  /// Reads a list of labels into `labels`, which is replaced.
  ///
  /// @param what   names a label in an error
  /// @param least  the smallest label that is accepted
  /// @param end    one more than the largest label; if empty, the number of labels in the list
  void read_labels(std::vector<Index>& labels, std::string_view what, std::int64_t least,
                   std::optional<std::int64_t> end);

  /// Reads a list of vectors of three finite numbers.
  std::vector<Point> read_points();

  /// Reads the size and the opening parenthesis of a list of lists; returns the size.
  std::int64_t begin_lists(std::string_view what);
  /// Reads the closing parenthesis of a list of lists.
  void end_lists(std::string_view what);

  /// Takes the next word, quoted text or punctuation mark; empty at the end of the file. Quotes are left out.
  std::string_view token();
  /// Returns whether only blanks and comments are left.
  [[nodiscard]] bool at_end();

 private:
  void read_header();
  void read_arch(std::string_view arch);
  void skip_blanks();
  [[nodiscard]] bool at(char mark);
  bool take(char mark);
  void expect(char mark, std::string_view what);
  [[nodiscard]] std::int64_t line_at(std::size_t position) const;
  [[nodiscard]] std::int64_t bytes_left() const noexcept {
    return static_cast<std::int64_t>(text_.size() - position_);
  }

  /// Takes the next word if it is a number that T holds.
  template <class T>
  std::errc take_number(T& value);
  /// Throws an InputError if the list that follows is text in a file whose header says `format binary`.
  void refuse_text() const;
  /// Throws an InputError at the next word, which is not the number that `needed` describes.
  [[noreturn]] void fail_number(std::string_view what, std::string_view needed);
  std::int64_t integer(std::string_view what);
  double finite(std::string_view what);
  template <class T>
  T binary(std::string_view what);
  std::int64_t label(std::string_view what);
  double scalar(std::string_view what);
  /// Reads the size of a list whose entries have at least `bytes_each` bytes each.
  std::int64_t size(std::string_view what, std::int64_t bytes_each);
  /// Returns `label`, which was just read; throws InputError unless `least` ≤ `label` < `end`.
  Index checked(std::int64_t label, std::string_view what, std::int64_t least, std::int64_t end);
  Point point();

  std::string file_;
  std::string text_;
  std::size_t position_ = 0;
  std::string class_;
  std::size_t class_end_ = 0;  // position after the value of `class`
  std::string note_;
  bool binary_ = false;
  std::endian order_ = std::endian::little;  // byte order of binary numbers
  int label_bytes_ = 4;
  int scalar_bytes_ = 8;
};

}  // namespace meshorder::openfoam
