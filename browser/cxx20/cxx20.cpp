// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cxx20.hpp"

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

const char* after_digits(const char* at, const char* last) { return std::find_if_not(at, last, is_digit); }

/// Returns the end of the "inf", "infinity" or "nan" at the start of a text; `first` if there is none.
const char* after_name(const char* first, const char* last) {
  for (const std::string_view name : {"infinity", "inf", "nan"}) {
    if (last - first >= std::ssize(name) && std::equal(name.begin(), name.end(), first, [](char a, char b) {
          return a == std::tolower(static_cast<unsigned char>(b));
        })) {
      return first + name.size();
    }
  }
  return first;
}

/// Returns the end of the decimal number at the start of a text; `first` if there is none.
const char* after_number(const char* first, const char* last) {
  const char* const digits = first != last && *first == '-' ? first + 1 : first;
  if (const char* const end = after_name(digits, last); end != digits) return end;
  const char* end = after_digits(digits, last);
  bool is_number = end != digits;
  if (end != last && *end == '.') {
    const char* const fraction = end + 1;
    end = after_digits(fraction, last);
    is_number |= end != fraction;
  }
  if (!is_number) return first;
  if (end != last && (*end == 'e' || *end == 'E')) {
    const char* exponent = end + 1;
    if (exponent != last && (*exponent == '+' || *exponent == '-')) ++exponent;
    if (const char* const after = after_digits(exponent, last); after != exponent) end = after;
  }
  return end;
}

template <class Number>
std::from_chars_result parsed(const char* first, const char* last, Number& value,
                              Number (*read)(const char*, char**)) {
  const char* const end = after_number(first, last);
  if (end == first) return {first, std::errc::invalid_argument};
  const std::string text(first, end);
  const Number number = read(text.c_str(), nullptr);
  const bool is_name = std::isalpha(static_cast<unsigned char>(end[-1])) != 0;
  const bool vanished = number == 0 && text.find_first_of("123456789") < text.find_first_of("eE");
  if ((std::isinf(number) && !is_name) || vanished) return {end, std::errc::result_out_of_range};
  value = number;
  return {end, std::errc()};
}

std::to_chars_result put(char* first, char* last, std::string_view text) {
  if (last - first < std::ssize(text)) return {last, std::errc::value_too_large};
  return {std::copy(text.begin(), text.end(), first), std::errc()};
}

/// The shortest decimal number that reads back as the same double: digits · 10^exponent.
struct Shortest {
  std::string digits;
  int exponent = 0;

  explicit Shortest(double value) {
    const std::string text = fmt::format("{}", value);
    const std::size_t e = std::min(text.find('e'), text.size());
    const std::size_t point = std::min(text.find('.'), e);
    digits = text.substr(0, point) + text.substr(std::min(point + 1, e), e - std::min(point + 1, e));
    exponent = (e < text.size() ? std::atoi(text.c_str() + e + 1) : 0) -
               static_cast<int>(e - std::min(point + 1, e));
    digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
    while (digits.size() > 1 && digits.back() == '0') {
      digits.pop_back();
      ++exponent;
    }
    if (digits == "0") exponent = 0;
  }

  /// Returns whether GCC's library writes a number as 0.001 and not as 1e-03.
  [[nodiscard]] bool is_better_fixed() const {
    const int length = static_cast<int>(digits.size());
    return length == 1 ? exponent >= -3 && exponent <= 4 : exponent >= -(length + 3) && exponent <= 5;
  }

  [[nodiscard]] std::string fixed(double value) const {
    if (exponent > 0) return fmt::format("{:.0f}", value);
    std::string text = digits;
    const auto after = static_cast<std::size_t>(-exponent);
    if (after == 0) return text;
    if (text.size() <= after) text.insert(0, after + 1 - text.size(), '0');
    return text.insert(text.size() - after, ".");
  }

  [[nodiscard]] std::string scientific() const {
    const int e = exponent + static_cast<int>(digits.size()) - 1;
    return fmt::format("{}{}{}e{}{:02}", digits[0], digits.size() > 1 ? "." : "", digits.substr(1),
                       e < 0 ? '-' : '+', std::abs(e));
  }
};

}  // namespace

_LIBCPP_BEGIN_NAMESPACE_STD

from_chars_result from_chars(const char* first, const char* last, double& value) {
  return parsed(first, last, value, std::strtod);
}

from_chars_result from_chars(const char* first, const char* last, float& value) {
  return parsed(first, last, value, std::strtof);
}

to_chars_result to_chars(char* first, char* last, double value) {
  return to_chars(first, last, value, chars_format{});
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format) {
  if (!std::isfinite(value)) return put(first, last, fmt::format("{}", value));
  const double size = std::abs(value);
  const Shortest shortest(size);
  const bool is_fixed =
      format == chars_format::fixed || (format != chars_format::scientific && shortest.is_better_fixed());
  const std::string text = is_fixed ? shortest.fixed(size) : shortest.scientific();
  return put(first, last, std::signbit(value) ? "-" + text : text);
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision) {
  const char* const by = format == chars_format::fixed        ? "%.*f"
                         : format == chars_format::scientific ? "%.*e"
                                                              : "%.*g";
  std::string text(static_cast<size_t>(std::snprintf(nullptr, 0, by, precision, value)) + 1, '\0');
  std::snprintf(text.data(), text.size(), by, precision, value);
  text.pop_back();
  return put(first, last, text);
}

_LIBCPP_END_NAMESPACE_STD
#endif
