// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Fields of bulk data: MSC Nastran Quick Reference Guide, "Format of Bulk Data Entries".
#include "io/nastran/card.hpp"

#include "base/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

namespace meshorder::nastran {
namespace {

constexpr std::size_t kNameWidth = 8;
constexpr std::size_t kSmallWidth = 8;
constexpr std::size_t kLargeWidth = 16;
constexpr std::size_t kDataEnd = 72;  // the name of the next line follows this column
constexpr std::size_t kSmallFields = 8;
constexpr std::size_t kLargeFields = 4;

/// Returns the position after the line that begins at `begin` and after its line end.
std::size_t end_of_line(std::string_view text, std::size_t begin) {
  constexpr std::size_t kUsual = 128;  // limits the search: a text may have no line feeds
  const std::string_view ahead = text.substr(begin, kUsual);
  const std::size_t feed = ahead.find('\n');
  std::string_view line = ahead.substr(0, feed);
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (feed != std::string_view::npos && line.find('\r') == std::string_view::npos) return begin + feed + 1;
  std::size_t end = begin;
  while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
  if (end == text.size()) return end;
  const bool is_pair = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
  return end + (is_pair ? 2 : 1);
}

/// Returns a line without its end and comment.
std::string_view without_comment(std::string_view line) {
  while (line.ends_with('\n') || line.ends_with('\r')) line.remove_suffix(1);
  return line.substr(0, line.find('$'));
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

bool is_free(std::string_view line) { return line.find(',') != std::string_view::npos; }

/// Returns the first field of a line: the text before the first comma, or 8 columns if there is no comma.
std::string_view first_field(std::string_view line) {
  const std::size_t comma = line.find(',');
  return trimmed(line.substr(0, comma == std::string_view::npos ? kNameWidth : comma));
}

bool is_continuation(std::string_view line) {
  if (line.front() == '+' || line.front() == '*' || line.front() == ',') return true;
  if (!is_blank(line.front())) return false;
  const std::string_view first = first_field(line);
  return first.empty() || first.front() == '+' || first.front() == '*';
}

bool is_blank_line(std::string_view line) { return trimmed(line).empty(); }

/// Returns the name of a line without its mark, for comparison: "+A1" and "*A1" name the same line.
std::string_view line_name(std::string_view field) {
  if (!field.empty() && (field.front() == '+' || field.front() == '*')) field.remove_prefix(1);
  return trimmed(field);
}

/// Splits the lines of a card.
class Splitter {
 public:
  Splitter(std::string_view card, CardFields& result) : card_(card), result_(result) {}

  void split() {
    result_.fields.clear();
    result_.is_large = false;
    result_.fault = {};
    for (std::size_t begin = 0; begin < card_.size();) {
      const std::size_t end = end_of_line(card_, begin);
      const std::string_view line = without_comment(card_.substr(begin, end - begin));
      if (!is_blank_line(line)) add_line(begin, line);
      begin = end;
    }
  }

 private:
  void add_line(std::size_t begin, std::string_view line) {
    const bool first_line = result_.fields.empty();
    const bool free = is_free(line);
    const std::string_view name = first_field(line);
    const bool large = !name.empty() && (first_line ? name.back() == '*' : name.front() == '*');
    if (first_line) {
      result_.is_large = large;
      const auto at = static_cast<std::size_t>(name.data() - card_.data());
      result_.fields.push_back({at, name.size(), kNameWidth, name});
    } else {
      check_name(name);
    }
    if (free) {
      add_free(begin, line, large);
    } else {
      add_fixed(begin, line, large);
    }
  }

  /// Sets `fault` if the name of a line differs from the name at the end of the line before. Nastran ignores
  /// the first column of the latter name, whether it holds a mark or a letter.
  void check_name(std::string_view name) {
    const std::string_view own = line_name(name);
    if (own.empty() || line_name(next_name_).empty() || own == line_name(next_name_)) return;
    if (own != trimmed(next_name_.substr(1))) {
      result_.fault = "continuation lines do not follow their card";
    }
  }

  void add_fixed(std::size_t begin, std::string_view line, bool large) {
    const std::size_t width = large ? kLargeWidth : kSmallWidth;
    std::size_t field = result_.fields.size();
    result_.fields.resize(field + (kDataEnd - kNameWidth) / width);
    for (std::size_t column = kNameWidth; column < kDataEnd; column += width, ++field) {
      const std::size_t at = std::min(column, line.size());
      const std::string_view bytes = line.substr(at, width);
      result_.fields[field] = {begin + at, bytes.size(), width, trimmed(bytes)};
    }
    next_name_ = line.size() > kDataEnd ? trimmed(line.substr(kDataEnd, kNameWidth)) : "";
  }

  void add_free(std::size_t begin, std::string_view line, bool large) {
    const std::size_t most = large ? kLargeFields : kSmallFields;
    std::size_t at = line.find(',') + 1;
    next_name_ = {};
    bool ended = false;
    for (std::size_t k = 0;; ++k) {
      const std::size_t comma = ended ? line.size() : std::min(line.find(',', at), line.size());
      const std::string_view bytes = ended ? std::string_view() : line.substr(at, comma - at);
      const std::string_view text = trimmed(bytes);
      if (k == most) next_name_ = text;
      if (k > most && !text.empty()) result_.fault = "a line has more than ten fields";
      if (k < most) result_.fields.push_back({begin + (ended ? line.size() : at), bytes.size(), 0, text});
      ended = ended || comma == line.size();
      at = comma + 1;
      if (ended && k + 1 >= most) break;
    }
  }

  std::string_view card_;
  CardFields& result_;
  std::string_view next_name_;  // name that the next line should have
};

}  // namespace

bool Cards::next() {
  card_ = {end_, end_};
  is_orphan_ = false;
  while (at_ < end_) {
    const std::size_t begin = at_;
    at_ = end_of_line(text_, begin);
    const char first = text_[begin];
    if (first == '$' || first == '\n' || first == '\r') continue;
    const std::string_view line = without_comment(text_.substr(begin, at_ - begin));
    if (is_blank_line(line)) continue;
    card_ = {begin, at_};
    is_orphan_ = is_continuation(line);
    break;
  }
  for (std::size_t at = at_; at < end_ && card_.begin < card_.end;) {
    const std::size_t begin = at;
    if (is_letter(text_[begin])) break;
    at = end_of_line(text_, begin);
    const std::string_view line = without_comment(text_.substr(begin, at - begin));
    if (is_blank_line(line)) continue;
    if (!is_continuation(line)) break;
    card_.end = at_ = at;
  }
  return card_.begin < card_.end;
}

std::vector<Piece> parts_of_cards(std::string_view text, Piece whole, std::size_t bytes) {
  std::vector<Piece> parts;
  for (std::size_t begin = whole.begin; begin < whole.end;) {
    std::size_t end = begin + bytes;
    while (end < whole.end && !(text[end - 1] == '\n' && is_letter(text[end]))) {
      end = std::min(text.find('\n', end), whole.end - 1) + 1;
    }
    end = std::min(end, whole.end);
    parts.push_back({begin, end});
    begin = end;
  }
  return parts;
}

void split_card(std::string_view card, CardFields& result) { Splitter(card, result).split(); }

std::string name_of(const CardFields& card) {
  std::string_view name = card.text(0);
  if (name.ends_with('*')) name.remove_suffix(1);
  return upper_case(trimmed(name));
}

std::optional<std::int64_t> integer_of(std::string_view field) {
  if (field.size() > 1 && field.front() == '+' && field[1] != '-') field.remove_prefix(1);
  std::int64_t value = 0;
  if (field.size() < kLargeWidth && !field.empty()) {  // usually some digits, and nothing else
    const auto* at = field.begin();
    for (; at != field.end() && *at >= '0' && *at <= '9'; ++at) value = 10 * value + (*at - '0');
    if (at == field.end()) return value;
  }
  const auto [after, code] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (code != std::errc{} || after != field.data() + field.size()) return {};
  return value;
}

std::int64_t number_of(std::string_view field) {
  const auto value = integer_of(field);
  return value && *value > 0 ? *value : 0;
}

std::optional<double> real_of(std::string_view field) {
  constexpr std::size_t kLongest = 60;
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  const std::size_t sign = !field.empty() && field.front() == '-' ? 1 : 0;
  const bool begins = field.size() > sign && field.size() <= kLongest &&
                      (std::isdigit(static_cast<unsigned char>(field[sign])) != 0 || field[sign] == '.');
  if (!begins) return {};
  double value = 0;
  const auto finite = [&]() { return std::isfinite(value) ? std::optional(value) : std::nullopt; };
  const char* const end = field.data() + field.size();
  const auto [after_plain, plain] = std::from_chars(field.data(), end, value);
  if (plain == std::errc{} && after_plain == end) return finite();
  // 1.5-3, 1.5D-3, 1.5E+3
  std::array<char, kLongest + 2> text{};
  char* to = text.data();
  for (std::size_t k = 0; k < field.size(); ++k) {
    const char c = field[k];
    const bool is_letter = c == 'd' || c == 'D' || c == 'e' || c == 'E';
    const bool is_sign = c == '+' || c == '-';
    const bool after_letter = to != text.data() && to[-1] == 'e';
    if (is_letter || (is_sign && k > 0 && !after_letter)) *to++ = 'e';
    if (!is_letter && c != '+') *to++ = c;
  }
  const auto [after, code] = std::from_chars(text.data(), to, value);
  if (code != std::errc{} || after != to) return {};
  return finite();
}

bool append_edited(std::string& out, std::string_view card, const CardFields& fields,
                   const std::vector<Edit>& edits) {
  std::size_t done = 0;
  for (const Edit& edit : edits) {
    const Field& field = fields.fields[edit.field];
    std::array<char, 24> digits{};
    char* const end = edit.number == 0
                          ? digits.data()
                          : std::to_chars(digits.data(), digits.data() + digits.size(), edit.number).ptr;
    const std::string_view text(digits.data(), static_cast<std::size_t>(end - digits.data()));
    out.append(card.substr(done, field.begin - done));
    done = field.begin + field.length;
    if (field.width == 0) {
      // the blanks around the old number stay
      const auto before =
          static_cast<std::size_t>(field.text.empty() ? 0 : field.text.data() - (card.data() + field.begin));
      out.append(card.substr(field.begin, before)).append(text);
      out.append(
          card.substr(field.begin + before + field.text.size(), field.length - before - field.text.size()));
      continue;
    }
    if (text.size() > field.width) return false;
    const std::size_t blanks = field.width - text.size();
    const bool at_left = !field.text.empty() && field.text.data() == card.data() + field.begin;
    if (!at_left) out.append(blanks, ' ');
    out.append(text);
    if (at_left && field.length == field.width) out.append(blanks, ' ');
    // a number at the left of its field is not padded if the line ends within this field
  }
  out.append(card.substr(done));
  return true;
}

void append_card(std::string& out, std::string_view name, const std::vector<std::string>& texts,
                 std::string_view line_end) {
  const bool large = std::any_of(texts.begin(), texts.end(),
                                 [](const std::string& text) { return text.size() > kSmallWidth; });
  const std::size_t width = large ? kLargeWidth : kSmallWidth;
  const std::size_t on_line = large ? kLargeFields : kSmallFields;
  std::string head(name);
  if (large) head += '*';
  for (std::size_t k = 0; k < texts.size(); ++k) {
    if (k % on_line == 0) {
      if (k > 0) out.append(line_end);
      if (k > 0) head = large ? "*" : "+";
      out.append(head).append(kNameWidth - head.size(), ' ');
    }
    out.append(width - texts[k].size(), ' ').append(texts[k]);
  }
  out.append(line_end);
}

namespace {

/// Removes the letter and leading zeros of an exponent, and a zero before the point; adds a missing point.
std::string as_field(std::string_view number) {
  const std::size_t e = number.find('e');
  std::string mantissa(number.substr(0, e));
  if (mantissa.find('.') == std::string::npos) mantissa += '.';
  const std::size_t zero = mantissa.front() == '-' ? 1 : 0;
  if (mantissa.size() > zero + 2 && mantissa[zero] == '0') mantissa.erase(zero, 1);
  if (e == std::string_view::npos) return mantissa;
  std::string_view exponent = number.substr(e + 1);
  mantissa += exponent.front() == '-' ? '-' : '+';
  exponent.remove_prefix(std::min(exponent.find_first_not_of("+-0"), exponent.size() - 1));
  return mantissa.append(exponent);
}

std::string chars_of(double value, std::chars_format format) {
  std::array<char, 400> buffer{};
  char* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format).ptr;
  return as_field({buffer.data(), static_cast<std::size_t>(end - buffer.data())});
}

std::string shortest(double value) {
  std::string fixed = chars_of(value, std::chars_format::fixed);
  std::string scientific = chars_of(value, std::chars_format::scientific);
  return fixed.size() <= std::max(scientific.size(), kLargeWidth - 1) ? fixed : scientific;
}

}  // namespace

RealText real_text(double value) {
  std::string text = shortest(value);
  double rounded = value;
  // from 16 significant digits down: 17 would give the same long text
  for (int digits = 15; digits > 0 && text.size() > kLargeWidth; --digits) {
    std::array<char, 40> buffer{};
    char* const begin = buffer.data();
    char* const end =
        std::to_chars(begin, begin + buffer.size(), value, std::chars_format::scientific, digits).ptr;
    if (std::from_chars(begin, end, rounded).ec != std::errc{}) continue;  // above the largest number
    text = shortest(rounded);
  }
  if (text.size() > kLargeWidth) {
    constexpr double kLargest = 1.797693134e308;
    rounded = std::copysign(kLargest, value);
    text = shortest(rounded);
  }
  return {std::move(text), rounded != value};
}

}  // namespace meshorder::nastran
