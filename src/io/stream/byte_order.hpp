// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace meshorder {

/// Returns the number with its bytes in reverse order.
template <class Number>
Number swapped_bytes(Number number) noexcept {
  static_assert(std::is_arithmetic_v<Number>);
  if constexpr (sizeof(Number) == 8) {
    return std::bit_cast<Number>(__builtin_bswap64(std::bit_cast<std::uint64_t>(number)));
  } else if constexpr (sizeof(Number) == 4) {
    return std::bit_cast<Number>(__builtin_bswap32(std::bit_cast<std::uint32_t>(number)));
  } else if constexpr (sizeof(Number) == 2) {
    return std::bit_cast<Number>(__builtin_bswap16(std::bit_cast<std::uint16_t>(number)));
  } else {
    return number;
  }
}

/// Reads a number at an address, which need not be aligned.
template <class Number>
Number number_at(const char* bytes, std::endian order) noexcept {
  Number number{};
  std::memcpy(&number, bytes, sizeof(Number));
  return order == std::endian::native ? number : swapped_bytes(number);
}

/// Writes a number to an address, which need not be aligned; returns the address after the number.
template <class Number>
char* put_number(char* bytes, Number number, std::endian order) noexcept {
  if (order != std::endian::native) number = swapped_bytes(number);
  std::memcpy(bytes, &number, sizeof(Number));
  return bytes + sizeof(Number);
}

}  // namespace meshorder
