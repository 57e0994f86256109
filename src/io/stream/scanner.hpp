// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/byte_order.hpp"
#include "io/stream/digits.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/error.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace meshorder {

/// Reads one file from front to back, as text (words and lines) or as binary numbers. Errors name the line or
/// byte.
///
/// Lines may end in LF, CRLF or CR, mixed. Words are separated by blanks, tabs and line ends. A comment
/// extends from the comment character, if there is one, to the end of its line. Zero bytes and Ctrl-Z at the
/// end of a text are left out.
class Scanner {
 public:
  /// Reads the whole file. Throws as `FilePath::read`, and InputError if it has no text or is UTF-16.
  explicit Scanner(const FilePath& file, char comment = '\0');

  /// Returns a scanner of the same text at another place.
  ///
  /// @param byte  0 … size of the text
  /// @param line  the line of that byte
  [[nodiscard]] Scanner at(std::int64_t byte, std::int64_t line) const;
  /// Returns a scanner of all bytes of the file. Other scanners skip the byte order mark of UTF-8 and
  /// padding; in a binary file both may be data.
  [[nodiscard]] Scanner of_all_bytes() const;
  /// Adds the bytes to the text that were left out as padding: in a binary file they may be data. O(1).
  void keep_padding();
  /// Moves to the position of another scanner of the same text; keeps the larger `last_comment` of both.
  /// O(1).
  void move_to(const Scanner& other);

  // ---- position
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] std::int64_t line() const noexcept { return line_; }
  [[nodiscard]] std::int64_t byte() const noexcept { return static_cast<std::int64_t>(position_); }
  [[nodiscard]] std::int64_t bytes_left() const noexcept {
    return static_cast<std::int64_t>(text_.size() - position_);
  }
  /// Returns the whole text, for formats that look ahead.
  [[nodiscard]] std::string_view all() const noexcept { return text_; }
  /// Returns the character that begins a comment, \0 for none.
  [[nodiscard]] char comment() const noexcept { return comment_; }
  /// Returns the position after the first byte of the last skipped comment, 0 if there is none. Comments
  /// within lines that `raw_line` returned are not skipped.
  [[nodiscard]] std::size_t last_comment() const noexcept { return last_comment_; }
  /// Moves to that byte. O(bytes moved).
  void seek(std::int64_t byte);
  /// Moves on by `bytes` bytes of this line. O(1).
  void move_on(std::size_t bytes) { position_ += bytes; }

  /// Throws an Error at the current line.
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;
  /// Throws an Error at the current byte.
  [[noreturn]] void fail_at_byte(const std::string& what, const std::string& remedy) const;

  // ---- words
  /// Skips blanks, line ends and comments; returns true if nothing is left.
  bool at_end();
  /// Skips blanks and comments on this line only; returns true at its end.
  bool at_line_end() {
    if (skip_spaces()) return false;
    if (text_[position_] == '\n') return true;  // most lines end here
    skip_blanks();
    return at_break();
  }
  /// Takes the next word, on any line; `what` names the word in the error at the end of the file.
  std::string_view word(std::string_view what);
  /// Returns the next word without taking it; empty at the end of the file.
  std::string_view peek_word();
  /// Takes the next word if all of it is a plain number in the range of T; otherwise returns false and does
  /// not take it. Reads each byte once; `word` and a parser would read each byte twice.
  template <class T>
  bool take_number(T& value);
  /// As `take_number`. Also takes a number that is not finite, but then returns false.
  bool take_finite(double& value) { return take_number(value) && std::isfinite(value); }
  /// Takes the next word as an integer of type T.
  template <class T>
  T integer(std::string_view what);
  /// Takes the next word as a position from 1 to `last`; returns the position counted from 0.
  Index position(std::string_view what, Index last) {
    const auto number = integer<std::int64_t>(what);
    if (number < 1 || number > last) fail_position(what, number, last);
    return static_cast<Index>(number - 1);
  }
  /// Takes the next word as a real number; accepts `nan`, `inf` and Fortran's 1.0D3.
  double real(std::string_view what);
  /// Takes the next word as a finite real number.
  double finite(std::string_view what);
  /// Takes the next word as a count of items, 0 … kMaxIndex. Fails if the rest of the file is too short for
  /// these items at `min_bytes` each: a wrong count cannot cause a huge allocation.
  Index count(std::string_view what, std::int64_t min_bytes);
  /// Checks a count that was read already.
  [[nodiscard]] Index checked_count(std::int64_t number, std::string_view what, std::int64_t min_bytes) const;

  // ---- lines
  /// Takes the rest of the line without its end and comment; moves to the next line.
  std::string_view rest_of_line();
  /// Takes the rest of the line verbatim, comment included; moves to the next line.
  std::string_view raw_line();
  /// Returns how many words the rest of the line has, without its comment.
  [[nodiscard]] int words_in_line() const;
  /// Returns the rest of the line verbatim without taking it.
  [[nodiscard]] std::string_view peek_line() const;

  // ---- binary
  /// Takes the next number in the given byte order.
  template <class T>
  T binary(std::string_view what, std::endian order = std::endian::native);
  /// Takes the next `bytes` bytes verbatim.
  std::string_view binary_block(std::int64_t bytes, std::string_view what);

 private:
  [[noreturn]] void fail_not_finite(std::string_view what) const;
  [[noreturn]] void fail_position(std::string_view what, std::int64_t number, Index last) const;
  void skip_blanks();
  void next_line();
  [[nodiscard]] bool at_break() const;
  /// Skips spaces; returns whether a word follows at once. If not, a word may still follow, for example after
  /// a tab.
  bool skip_spaces() {
    while (text_[position_] == ' ') ++position_;  // a zero byte or Ctrl-Z ends the text
    return text_[position_] > ' ' && text_[position_] != comment_;
  }
  /// Skips spaces and line feeds; returns whether a word follows at once.
  bool skip_to_word() {
    while (!skip_spaces()) {
      if (text_[position_] != '\n') return false;
      ++position_;
      ++line_;
    }
    return true;
  }
  /// Takes a number of at most seven digits, without sign or point, that ends before a space or line feed.
  /// Otherwise returns false, and skips only spaces and line feeds. Most numbers of a mesh have this form.
  template <class T>
  bool take_digits(T& value);
  template <class T>
  bool take_any_number(T& value);

  std::string file_;
  std::shared_ptr<const std::string> whole_;  ///< shared by scanners of one text
  std::string_view text_;                     ///< part of `*whole_`; a zero byte or Ctrl-Z follows it
  std::size_t position_ = 0;
  std::int64_t line_ = 1;
  std::size_t last_comment_ = 0;
  char comment_;
};

/// Returns `text` as an integer of type T, with an optional sign; throws an Error at the scanner's line.
template <class T>
T parse_integer(const Scanner& at, std::string_view text, std::string_view what);

/// Returns `text` as a real number; throws an Error at the scanner's line.
double parse_real(const Scanner& at, std::string_view text, std::string_view what);

/// Returns at most 40 characters of `text` for a message, with `?` for characters that cannot be printed.
std::string shown(std::string_view text);

extern template std::int32_t parse_integer<std::int32_t>(const Scanner&, std::string_view, std::string_view);
extern template std::int64_t parse_integer<std::int64_t>(const Scanner&, std::string_view, std::string_view);
extern template std::uint64_t parse_integer<std::uint64_t>(const Scanner&, std::string_view,
                                                           std::string_view);

template <class T>
bool Scanner::take_digits(T& value) {
  if (!skip_to_word()) return false;
  if (text_.size() - position_ < 8) return false;
  const char* const begin = text_.data() + position_;
  const Digits digits = leading_digits(begin);
  const bool fits = digits.count > 0 && digits.count < 8 && digits.count <= std::numeric_limits<T>::digits10;
  if (!fits || (begin[digits.count] != ' ' && begin[digits.count] != '\n')) return false;
  position_ += static_cast<std::size_t>(digits.count);
  value = static_cast<T>(digits.number);
  return true;
}

template <class T>
bool Scanner::take_number(T& value) {
  if constexpr (std::is_integral_v<T>) {
    if (take_digits(value)) return true;
  }
  return take_any_number(value);
}

template <class T>
T Scanner::integer(std::string_view what) {
  T value{};
  return take_number(value) ? value : parse_integer<T>(*this, word(what), what);
}

inline double Scanner::real(std::string_view what) {
  double value = 0;
  return take_number(value) ? value : parse_real(*this, word(what), what);
}

inline double Scanner::finite(std::string_view what) {
  const double value = real(what);
  if (!std::isfinite(value)) fail_not_finite(what);
  return value;
}

template <class T>
T Scanner::binary(std::string_view what, std::endian order) {
  static_assert(std::is_arithmetic_v<T>);
  if (text_.size() - position_ < sizeof(T)) (void)binary_block(sizeof(T), what);  // throws
  const char* const bytes = text_.data() + position_;
  position_ += sizeof(T);
  return number_at<T>(bytes, order);
}

}  // namespace meshorder
