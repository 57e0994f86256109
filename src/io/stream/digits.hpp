// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace meshorder {

/// The leading digits of a text: their count and, if there are at most 7, the number that they form.
struct Digits {
  int count = 0;  ///< 8 means eight or more; then `number` is 0
  std::uint32_t number = 0;
};

/// Reads the leading digits of 8 bytes at once, without a branch for each digit. Most numbers of a mesh have
/// fewer than 8 digits.
inline Digits leading_digits(const char* text) noexcept {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, text, sizeof(bytes));
  if constexpr (std::endian::native == std::endian::big) {
    std::uint64_t reversed = 0;
    for (int k = 0; k < 8; ++k) reversed |= ((bytes >> (8 * k)) & 0xFFU) << (56 - 8 * k);
    bytes = reversed;
  }
  // `values` has 0 … 9 for the digits 0x30 … 0x39; `others` has the highest bit of each byte that is no digit
  constexpr std::uint64_t kOnes = 0x0101010101010101U;
  const std::uint64_t values = bytes ^ (kOnes * '0');
  const std::uint64_t others = (values | ((values & (kOnes * 0x7FU)) + kOnes * 0x76U)) & (kOnes * 0x80U);
  const int count = std::countr_zero(others) / 8;
  if (count == 0 || count == 8) return {count, 0};
  // moves the digits to the last bytes, after zeros; then combines digits to pairs, to fours and to the
  // number
  std::uint64_t number = values << (64 - 8 * count);
  number = number * 10 + (number >> 8U);
  number = ((number & 0x000000FF000000FFU) * 0x000F424000000064U +
            ((number >> 16U) & 0x000000FF000000FFU) * 0x0000271000000001U) >>
           32U;
  return {count, static_cast<std::uint32_t>(number)};
}

constexpr std::uint32_t kDigitsAtOnce = 100'000'000;  ///< `put_digits` takes smaller numbers only

/// Writes the digits of a number below `kDigitsAtOnce` at once, without a branch for each digit. Returns the
/// end of the digits. May write 8 bytes even if there are fewer digits.
inline char* put_digits(char* at, std::uint32_t number) noexcept {
  // splits the number into fours, pairs and digits; the leading digits are in the lowest bytes
  const std::uint64_t fours = number / 10000 + (std::uint64_t{number % 10000} << 32U);
  const std::uint64_t hundreds = (fours * 10486 >> 20U) & 0x0000007F0000007FU;
  const std::uint64_t pairs = hundreds + ((fours - 100 * hundreds) << 16U);
  const std::uint64_t tens = (pairs * 103 >> 10U) & 0x000F000F000F000FU;
  const std::uint64_t digits = tens + ((pairs - 10 * tens) << 8U);
  const int zeros = digits == 0 ? 7 : std::countr_zero(digits) / 8;
  std::uint64_t text = (digits | (std::uint64_t{'0'} * 0x0101010101010101U)) >> (8 * zeros);
  if constexpr (std::endian::native == std::endian::big) {
    for (int k = 0; k < 8 - zeros; ++k) at[k] = static_cast<char>(text >> (8 * k));
  } else {
    std::memcpy(at, &text, sizeof(text));
  }
  return at + (8 - zeros);
}

}  // namespace meshorder
