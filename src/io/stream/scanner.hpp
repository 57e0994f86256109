// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/error.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace meshorder {

/// Reads one file from front to back, as text (words and lines) or as binary numbers, and knows at every
/// moment where it is, so that an error names the line or byte.
///
/// Lines may end in LF, CRLF or CR, mixed. Words are separated by blanks, tabs and line ends. A comment
/// runs from the comment character, if there is one, to the end of its line.
class Scanner {
 public:
  /// Reads the whole file. Throws Error for a folder, an unreadable or an empty file.
  explicit Scanner(const std::filesystem::path& path, char comment = '\0');

  // ---- where we are
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] std::int64_t line() const noexcept { return line_; }
  [[nodiscard]] std::int64_t byte() const noexcept { return static_cast<std::int64_t>(position_); }
  [[nodiscard]] std::int64_t bytes_left() const noexcept {
    return static_cast<std::int64_t>(text_.size() - position_);
  }
  /// Everything in the file; for formats that decide by a look ahead.
  [[nodiscard]] std::string_view all() const noexcept { return text_; }
  /// Goes to that byte; the line is counted anew when going back.
  void seek(std::int64_t byte);

  /// Stops with an Error at the current line.
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;
  /// Stops with an Error at the current byte.
  [[noreturn]] void fail_at_byte(const std::string& what, const std::string& remedy) const;

  // ---- words
  /// Skips blanks, line ends and comments; true when nothing is left.
  bool at_end();
  /// Skips blanks and comments on this line only; true at its end.
  bool at_line_end();
  /// The next word, on whichever line; `what` names it in the error at the end of the file.
  std::string_view word(std::string_view what);
  /// The next word without taking it; empty at the end of the file.
  std::string_view peek_word();
  /// The next word as an integer of type T.
  template <class T>
  T integer(std::string_view what);
  /// The next word as a real number; `nan` and `inf` are taken. Fortran's 1.0D3 is understood.
  double real(std::string_view what);
  /// The next word as a finite real number.
  double finite(std::string_view what);
  /// A count of things that take at least `least_bytes` each in what is left of the file, so that a header
  /// cannot promise (and make us allocate) what is not there. At most kMaxIndex.
  Index count(std::string_view what, std::int64_t least_bytes);
  /// The same check for a number that was read already.
  [[nodiscard]] Index checked_count(std::int64_t number, std::string_view what,
                                    std::int64_t least_bytes) const;

  // ---- lines
  /// The rest of the line without its end and without the comment; moves to the next line.
  std::string_view rest_of_line();
  /// The rest of the line as it stands, comment included; moves to the next line.
  std::string_view raw_line();
  /// The rest of the line as it stands, not taken: an error in it still names its line.
  [[nodiscard]] std::string_view peek_line() const;

  // ---- binary
  /// The next number in the given byte order.
  template <class T>
  T binary(std::string_view what, std::endian order = std::endian::native);
  /// The next `bytes` bytes as they stand.
  std::string_view binary_block(std::int64_t bytes, std::string_view what);

 private:
  void skip_blanks();
  void next_line();
  [[nodiscard]] bool at_break() const;

  std::string file_;
  std::string text_;
  std::size_t position_ = 0;
  std::int64_t line_ = 1;
  char comment_;
};

/// `text` as an integer of type T, or Error at the scanner's line. A sign may stand before it.
template <class T>
T parse_integer(const Scanner& at, std::string_view text, std::string_view what);

/// `text` as a real number, or Error at the scanner's line.
double parse_real(const Scanner& at, std::string_view text, std::string_view what);

/// Returns at most 40 characters of `text` for a message, with `?` for those that cannot be printed.
std::string shown(std::string_view text);

extern template std::int32_t parse_integer<std::int32_t>(const Scanner&, std::string_view, std::string_view);
extern template std::int64_t parse_integer<std::int64_t>(const Scanner&, std::string_view, std::string_view);
extern template std::uint64_t parse_integer<std::uint64_t>(const Scanner&, std::string_view,
                                                           std::string_view);

template <class T>
T Scanner::integer(std::string_view what) {
  return parse_integer<T>(*this, word(what), what);
}

template <class T>
T Scanner::binary(std::string_view what, std::endian order) {
  static_assert(std::is_arithmetic_v<T>);
  const std::string_view bytes = binary_block(sizeof(T), what);
  std::array<char, sizeof(T)> raw{};
  std::copy(bytes.begin(), bytes.end(), raw.begin());
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace meshorder
