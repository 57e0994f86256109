// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace meshorder {

/// Up to 7 digits of decimal text and the number that they are.
struct Digits {
  int count = 0;  ///< 8: eight or more, whose number is not given
  std::uint32_t number = 0;
};

/// Reads the digits at the beginning of 8 bytes all at once, without a branch for each. Most numbers of a
/// mesh have less than 8.
inline Digits leading_digits(const char* text) noexcept {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, text, sizeof(bytes));
  if constexpr (std::endian::native == std::endian::big) {
    std::uint64_t reversed = 0;
    for (int k = 0; k < 8; ++k) reversed |= ((bytes >> (8 * k)) & 0xFFU) << (56 - 8 * k);
    bytes = reversed;
  }
  // the byte of a digit has 3 above and 0 … 9 below; any other one gets a bit of 0xF0
  constexpr std::uint64_t kOnes = 0x0101010101010101U;
  const std::uint64_t values = bytes ^ (kOnes * '0');
  const std::uint64_t others = (values | ((values & (kOnes * 0x7FU)) + kOnes * 0x76U)) & (kOnes * 0x80U);
  const int count = std::countr_zero(others) / 8;
  if (count == 0 || count == 8) return {count, 0};
  // the digits to the end, zeros before them; then pairs, groups of four and all
  std::uint64_t number = values << (64 - 8 * count);
  number = number * 10 + (number >> 8U);
  number = ((number & 0x000000FF000000FFU) * 0x000F424000000064U +
            ((number >> 16U) & 0x000000FF000000FFU) * 0x0000271000000001U) >>
           32U;
  return {count, static_cast<std::uint32_t>(number)};
}

}  // namespace meshorder
