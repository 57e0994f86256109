// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/text.hpp"

#include <fmt/compile.h>

#include <charconv>
#include <iterator>

namespace meshorder {

void Text::print_all(fmt::string_view format, fmt::format_args args) {
  fmt::vformat_to(std::back_inserter(buffer_), format, args);
}

void Text::put_long(std::string_view before, std::int64_t value) {
  constexpr std::size_t kMostDigits = 20;
  char* const digits = std::copy(before.begin(), before.end(), room(before.size() + kMostDigits));
  written(std::to_chars(digits, digits + kMostDigits, value).ptr);
}

void Text::real(std::string_view before, double value) {
  constexpr std::size_t kMostCharacters = 32;
  char* const at = std::copy(before.begin(), before.end(), room(before.size() + kMostCharacters));
  written(fmt::format_to(at, FMT_COMPILE("{}"), value));
}

}  // namespace meshorder
