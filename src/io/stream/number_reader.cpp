// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/number_reader.hpp"

#include <charconv>
#include <cmath>

namespace meshorder {
namespace {

/// Parses `text`; returns whether all of it is a number of type T.
template <class T>
bool parse_all(std::string_view text, T& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc{} && end == text.data() + text.size();
}

}  // namespace

void NumberReader::fail(const std::string& what, const std::string& remedy) const {
  if (binary) scanner.fail_at_byte(what, remedy);
  scanner.fail(what, remedy);
}

double NumberReader::finite(std::string_view what) {
  if (!binary) return scanner.finite(what);
  const auto value = scanner.binary<double>(what, order);
  if (!std::isfinite(value)) fail(std::string(what) + " is not finite", "a finite number is needed");
  return value;
}

Index NumberReader::count(std::string_view what, std::int64_t text_bytes, std::int64_t binary_bytes) {
  const std::int64_t number = int64(what);
  return checked_count(number, what, binary ? binary_bytes : text_bytes);
}

Index NumberReader::checked_count(std::int64_t number, std::string_view what, std::int64_t bytes) const {
  if (!binary) return scanner.checked_count(number, what, bytes);
  const std::string given = std::string(what) + " is " + std::to_string(number);
  if (number < 0) fail(given, "it cannot be negative");
  if (number > kMaxIndex) fail(given, "at most 2147483647 are possible");
  if (number > scanner.bytes_left() / bytes) {
    fail(given + ", but only " + std::to_string(scanner.bytes_left()) + " bytes follow",
         "the count is wrong or the file is cut short");
  }
  return static_cast<Index>(number);
}

std::string_view NumberReader::word(std::string_view what) {
  if (binary && scanner.at_end()) {
    fail("unexpected end of file; expected " + std::string(what), "it may be cut short");
  }
  return scanner.word(what);
}

std::int64_t NumberReader::text_integer(std::string_view what) { return parsed(word(what), what); }

std::int64_t NumberReader::parsed(std::string_view text, std::string_view what) const {
  if (!binary) return parse_integer<std::int64_t>(scanner, text, what);
  std::int64_t value = 0;
  if (!parse_all(text, value)) {
    fail(std::string(what) + " is '" + shown(text) + "'", "a whole number is needed");
  }
  return value;
}

double NumberReader::text_real(std::string_view what) {
  const std::string_view text = word(what);
  if (!binary) return parse_real(scanner, text, what);
  double value = 0;
  if (!parse_all(text, value)) fail(std::string(what) + " is '" + shown(text) + "'", "a number is needed");
  return value;
}

void NumberReader::begin_binary() {
  if (binary) (void)scanner.raw_line();
}

}  // namespace meshorder
