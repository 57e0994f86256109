// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/scanner.hpp"

#include "base/text.hpp"
#include "io/stream/text_ends.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace meshorder {
namespace {

bool is_line_end(char c) { return c <= '\r' && (c == '\n' || c == '\r'); }

}  // namespace

std::string shown(std::string_view text) {
  std::string result;
  for (const char c : text.substr(0, 40)) result += (c >= ' ' && c < 127) ? c : '?';
  return text.size() > 40 ? result + "…" : result;
}

Scanner::Scanner(const FilePath& file, char comment)
    : file_(file.string()),
      whole_(std::make_shared<const std::string>(file.read())),
      text_(without_padding(without_byte_order_mark(*whole_))),
      comment_(comment) {
  constexpr std::string_view kWide("\xFE\xFF\0", 3);  // in little-endian UTF-16 the zero is the fourth byte
  const bool is_wide =
      whole_->starts_with(kWide) || (whole_->starts_with("\xFF\xFE") && whole_->find('\0') == 3);
  if (is_wide) throw InputError(file_, "is text in UTF-16", "save it in UTF-8");
  if (text_.empty()) throw InputError(file_, "has no text", "give a mesh file");
}

Scanner Scanner::at(std::int64_t byte, std::int64_t line) const {
  Scanner result = *this;
  result.position_ = static_cast<std::size_t>(byte);
  result.line_ = line;
  return result;
}

Scanner Scanner::of_all_bytes() const {
  Scanner result = *this;
  result.text_ = *whole_;
  result.position_ = 0;
  result.line_ = 1;
  return result;
}

void Scanner::keep_padding() {
  text_ = std::string_view(*whole_).substr(static_cast<std::size_t>(text_.data() - whole_->data()));
}

void Scanner::move_to(const Scanner& other) {
  position_ = other.position_;
  line_ = other.line_;
  last_comment_ = std::max(last_comment_, other.last_comment_);
}

void Scanner::seek(std::int64_t byte) {
  const auto target = std::min(static_cast<std::size_t>(byte), text_.size());
  const auto is_pair = [&](std::size_t k) { return text_[k] == '\r' && text_[k + 1] == '\n'; };
  const auto [first, last] = std::minmax(position_, target);
  std::int64_t lines = 0;
  // a CR LF pair that begins before `first` has been counted
  for (std::size_t k = first > 0 && is_pair(first - 1) ? first + 1 : first; k < last; ++k) {
    if (!is_line_end(text_[k])) continue;
    ++lines;
    if (is_pair(k)) ++k;
  }
  line_ += target < position_ ? -lines : lines;
  position_ = target;
}

void Scanner::fail(const std::string& what, const std::string& remedy) const {
  throw InputError(Location{file_, line_, -1}, what, remedy);
}

void Scanner::fail_at_byte(const std::string& what, const std::string& remedy) const {
  throw InputError(Location{file_, 0, byte()}, what, remedy);
}

bool Scanner::at_break() const { return position_ >= text_.size() || is_line_end(text_[position_]); }

void Scanner::skip_blanks() {
  while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
  if (comment_ != '\0' && position_ < text_.size() && text_[position_] == comment_) {
    last_comment_ = std::max(last_comment_, position_ + 1);
    while (!at_break()) ++position_;
  }
}

void Scanner::next_line() {
  if (position_ >= text_.size()) return;
  if (text_[position_] == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n') ++position_;
  ++position_;
  ++line_;
}

bool Scanner::at_end() {
  while (at_line_end()) {
    if (position_ >= text_.size()) return true;
    next_line();
  }
  return false;
}

std::string_view Scanner::peek_word() {
  if (at_end()) return {};
  const auto in_word = [&](char c) {
    const bool is_separator = static_cast<unsigned char>(c) <= ' ' && (is_blank(c) || is_line_end(c));
    return !is_separator && (comment_ == '\0' || c != comment_);
  };
  std::size_t end = position_;
  while (end < text_.size() && in_word(text_[end])) ++end;
  return text_.substr(position_, end - position_);
}

std::string_view Scanner::word(std::string_view what) {
  const std::string_view result = peek_word();
  if (result.empty()) {
    fail("unexpected end of file; expected " + std::string(what), "it may be cut short");
  }
  position_ += result.size();
  return result;
}

template <class T>
bool Scanner::take_any_number(T& value) {
  if (!skip_to_word() && at_end()) return false;
  const char* const end = text_.data() + text_.size();
  const auto [after, code] = std::from_chars(text_.data() + position_, end, value);
  const bool whole =
      after == end || is_blank(*after) || is_line_end(*after) || (comment_ != '\0' && *after == comment_);
  if (code != std::errc{} || !whole) return false;
  position_ = static_cast<std::size_t>(after - text_.data());
  return true;
}

template bool Scanner::take_any_number<std::int32_t>(std::int32_t&);
template bool Scanner::take_any_number<std::int64_t>(std::int64_t&);
template bool Scanner::take_any_number<std::uint64_t>(std::uint64_t&);
template bool Scanner::take_any_number<double>(double&);

void Scanner::fail_position(std::string_view what, std::int64_t number, Index last) const {
  fail(std::string(what) + " is " + std::to_string(number), "1 to " + std::to_string(last) + " are possible");
}

void Scanner::fail_not_finite(std::string_view what) const {
  fail(std::string(what) + " is not finite", "a finite number is needed");
}

Index Scanner::count(std::string_view what, std::int64_t min_bytes) {
  return checked_count(integer<std::int64_t>(what), what, min_bytes);
}

Index Scanner::checked_count(std::int64_t number, std::string_view what, std::int64_t min_bytes) const {
  // the last item of a text file may lack its line end
  const std::int64_t most = (bytes_left() + 1) / std::max<std::int64_t>(min_bytes, 1);
  if (number == 0 || (number > 0 && number <= most && number <= kMaxIndex)) return static_cast<Index>(number);
  const std::string shown_count = std::string(what) + " is " + std::to_string(number);
  if (number < 0) fail(shown_count, "it cannot be negative");
  if (number > kMaxIndex) fail(shown_count, "at most 2147483647 are possible");
  fail(shown_count + ", but only " + std::to_string(bytes_left()) + " bytes follow",
       "the count is wrong or the file is cut short");
}

std::string_view Scanner::rest_of_line() {
  const std::size_t begin = position_;
  while (!at_break() && (comment_ == '\0' || text_[position_] != comment_)) ++position_;
  std::string_view result = text_.substr(begin, position_ - begin);
  skip_blanks();
  next_line();
  while (!result.empty() && is_blank(result.back())) result.remove_suffix(1);
  while (!result.empty() && is_blank(result.front())) result.remove_prefix(1);
  return result;
}

std::string_view Scanner::raw_line() {
  const std::size_t begin = position_;
  while (!at_break()) ++position_;
  const std::string_view result = text_.substr(begin, position_ - begin);
  next_line();
  return result;
}

int Scanner::words_in_line() const {
  int words = 0;
  bool in_word = false;
  for (std::size_t at = position_; at < text_.size() && !is_line_end(text_[at]); ++at) {
    if (comment_ != '\0' && text_[at] == comment_) break;
    const bool of_word = !is_blank(text_[at]);
    if (of_word && !in_word) ++words;
    in_word = of_word;
  }
  return words;
}

std::string_view Scanner::peek_line() const {
  std::size_t end = position_;
  while (end < text_.size() && !is_line_end(text_[end])) ++end;
  return text_.substr(position_, end - position_);
}

std::string_view Scanner::binary_block(std::int64_t bytes, std::string_view what) {
  if (bytes < 0 || bytes > bytes_left()) {
    fail_at_byte("unexpected end of file in " + std::string(what), "it may be cut short");
  }
  const auto result = text_.substr(position_, static_cast<std::size_t>(bytes));
  position_ += result.size();
  return result;
}

template <class T>
T parse_integer(const Scanner& at, std::string_view text, std::string_view what) {
  T value{};
  std::string_view digits = text;
  if (digits.size() > 1 && digits.front() == '+') digits.remove_prefix(1);
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::result_out_of_range) {
    at.fail(std::string(what) + " is " + shown(text), "it is too large");
  }
  if (code != std::errc{} || end != digits.data() + digits.size()) {
    at.fail(std::string(what) + " is '" + shown(text) + "'", "a whole number is needed");
  }
  return value;
}

template std::int32_t parse_integer<std::int32_t>(const Scanner&, std::string_view, std::string_view);
template std::int64_t parse_integer<std::int64_t>(const Scanner&, std::string_view, std::string_view);
template std::uint64_t parse_integer<std::uint64_t>(const Scanner&, std::string_view, std::string_view);

double parse_real(const Scanner& at, std::string_view text, std::string_view what) {
  std::string_view digits = text;
  if (digits.size() > 1 && digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  std::string with_e;
  if (code == std::errc{} && end != digits.data() + digits.size() && (*end == 'd' || *end == 'D')) {
    with_e = digits;
    with_e[static_cast<std::size_t>(end - digits.data())] = 'e';
    digits = with_e;
    const auto again = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    end = again.ptr;
    code = again.ec;
  }
  const bool whole = end == digits.data() + digits.size();
  if (code == std::errc::result_out_of_range && whole) {
    // underflow is 0, overflow an error
    if (digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos) return 0;
    at.fail(std::string(what) + " is " + shown(text), "it is too large");
  }
  if (code != std::errc{} || !whole) {
    at.fail(std::string(what) + " is '" + shown(text) + "'", "a number is needed");
  }
  return value;
}

}  // namespace meshorder
