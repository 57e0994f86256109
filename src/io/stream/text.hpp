// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/byte_order.hpp"
#include "io/stream/digits.hpp"

#include <fmt/compile.h>
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <type_traits>

namespace meshorder {

/// A text in memory, to which numbers and texts are appended.
class Text {
 public:
  /// Appends formatted text; a double written as `{}` reads back to the same bits.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    print_all(format, fmt::make_format_args(args...));
  }
  void print_all(fmt::string_view format, fmt::format_args args) {
    fmt::vformat_to(std::back_inserter(buffer_), format, args);
  }

  void write(std::string_view bytes) { buffer_.append(bytes.data(), bytes.data() + bytes.size()); }

  /// Appends `before` and the digits of `value`; faster than `print`.
  void integer(std::string_view before, std::int64_t value) {
    if (value < 0 || value >= kDigitsAtOnce) return put_long(before, value);
    char* const at = std::copy(before.begin(), before.end(), room(before.size() + sizeof(std::uint64_t)));
    written(put_digits(at, static_cast<std::uint32_t>(value)));
  }

  /// Appends `before` and the number as `print` does for `{}`, but faster.
  void real(std::string_view before, double value) {
    constexpr std::size_t kMostCharacters = 32;
    char* const at = std::copy(before.begin(), before.end(), room(before.size() + kMostCharacters));
    written(fmt::format_to(at, FMT_COMPILE("{}"), value));
  }

  /// Appends numbers, each after a blank.
  void reals(std::span<const double> values) {
    for (const double value : values) real(" ", value);
  }

  /// Appends `before` and a number of any type as `print` does for `{}`, by the fastest of these functions.
  template <class Number>
  void number(std::string_view before, Number value) {
    if constexpr (std::is_same_v<Number, double>) {
      real(before, value);
    } else if constexpr (std::is_integral_v<Number> && (sizeof(Number) < 8 || std::is_signed_v<Number>)) {
      integer(before, value);
    } else {
      print("{}{}", before, value);
    }
  }

  /// Appends the number's bytes in the given order.
  template <class T>
  void binary(T value, std::endian order) {
    written(put_number(room(sizeof(T)), value, order));
  }

  /// Returns room for `bytes` more bytes. The caller must next call `written` with the end of the bytes that
  /// it put there.
  [[nodiscard]] char* room(std::size_t bytes) {
    buffer_.reserve(buffer_.size() + bytes);
    return buffer_.data() + buffer_.size();
  }
  void written(const char* end) { buffer_.resize(static_cast<std::size_t>(end - buffer_.data())); }

  [[nodiscard]] std::size_t size() const noexcept { return buffer_.size(); }
  [[nodiscard]] std::string_view view() const noexcept { return {buffer_.data(), buffer_.size()}; }
  [[nodiscard]] char* data() noexcept { return buffer_.data(); }
  void clear() noexcept { buffer_.clear(); }

 private:
  void put_long(std::string_view before, std::int64_t value) {
    constexpr std::size_t kMostDigits = 20;
    char* const digits = std::copy(before.begin(), before.end(), room(before.size() + kMostDigits));
    written(std::to_chars(digits, digits + kMostDigits, value).ptr);
  }

  fmt::memory_buffer buffer_;
};

}  // namespace meshorder
