// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/abaqus/abaqus.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace meshorder::abaqus {
namespace {

constexpr std::size_t kMostCharacters = 20;

/// Removes the plus and the leading zeros of an exponent. Returns the new end.
char* without_padding(char* begin, char* end) {
  char* const e = std::find(begin, end, 'e');
  if (e == end) return end;
  char* to = e + 1;
  char* from = e + 1;
  if (*from == '-') *to++ = *from;
  while (from + 1 < end && std::isdigit(static_cast<unsigned char>(*from)) == 0) ++from;
  while (from + 1 < end && *from == '0') ++from;
  return std::copy(from, end, to);
}

}  // namespace

RealText::RealText(double value) {
  char* const begin = buffer.data();
  const auto write = [&](double number, auto... format) {
    char* const end = std::to_chars(begin, begin + buffer.size(), number, format...).ptr;
    size = static_cast<std::size_t>(without_padding(begin, end) - begin);
  };
  const auto write_shortest = [&](double number) {
    write(number);
    if (size > kMostCharacters) write(number, std::chars_format::scientific);
  };
  write_shortest(value);
  double rounded = value;
  for (int digits = 16; size > kMostCharacters; --digits) {
    write(value, std::chars_format::scientific, digits);
    std::from_chars(begin, begin + size, rounded);
    if (size <= kMostCharacters) write_shortest(rounded);  // drops trailing zeros
  }
  is_rounded = rounded != value;
}

}  // namespace meshorder::abaqus
