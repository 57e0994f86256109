// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/base64.hpp"

#include <array>
#include <cstring>

namespace meshorder {
namespace {

using Pair = std::array<char, 2>;

/// The two characters for each value of 12 bits.
constexpr std::array<Pair, 4096> kPairs = [] {
  std::array<Pair, 4096> pairs{};
  for (std::size_t bits = 0; bits < pairs.size(); ++bits)
    pairs[bits] = {kBase64Alphabet[bits >> 6U], kBase64Alphabet[bits & 63U]};
  return pairs;
}();

constexpr std::uint32_t kNone = 64;

/// The value of each character of base64; kNone for other characters.
constexpr std::array<std::uint8_t, 256> kValues = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNone);
  for (std::size_t i = 0; i < kBase64Alphabet.size(); ++i)
    values[static_cast<unsigned char>(kBase64Alphabet[i])] = static_cast<std::uint8_t>(i);
  return values;
}();

std::uint32_t byte_of(char c) { return static_cast<unsigned char>(c); }

/// Writes the four characters of 24 bits; returns the address after them.
char* put_group(char* at, std::uint32_t bits) {
  std::memcpy(at, kPairs[bits >> 12U].data(), 2);
  std::memcpy(at + 2, kPairs[bits & 4095U].data(), 2);
  return at + 4;
}

}  // namespace

std::string Base64Encoder::put(std::span<const char> bytes) {
  std::string text((held_ + bytes.size()) / 3 * 4, '\0');
  char* at = text.data();
  std::size_t i = 0;
  for (; held_ > 0 && i < bytes.size(); ++i) {
    packed_ = (packed_ << 8U) | byte_of(bytes[i]);
    if (++held_ < 3) continue;
    at = put_group(at, packed_);
    packed_ = 0;
    held_ = 0;
  }
  for (; i + 3 <= bytes.size(); i += 3)
    at = put_group(at, byte_of(bytes[i]) << 16U | byte_of(bytes[i + 1]) << 8U | byte_of(bytes[i + 2]));
  for (; i < bytes.size(); ++i, ++held_) packed_ = (packed_ << 8U) | byte_of(bytes[i]);
  return text;
}

std::string Base64Encoder::finish() {
  if (held_ == 0) return {};
  const unsigned missing = 3 - held_;
  std::string text(4, '\0');
  put_group(text.data(), packed_ << (8U * missing));
  packed_ = 0;
  held_ = 0;
  return text.replace(4 - missing, missing, missing, '=');
}

std::string to_base64(std::span<const char> bytes) {
  Base64Encoder encoder;
  std::string text = encoder.put(bytes);
  return text += encoder.finish();
}

bool from_base64(std::string_view text, std::span<char> bytes) {
  if (base64_length(bytes.size()) > text.size()) return false;
  const std::size_t whole = bytes.size() / 3;
  const char* from = text.data();
  char* to = bytes.data();
  std::uint32_t seen = 0;  // kNone sets a bit that no value has
  for (std::size_t group = 0; group < whole; ++group, from += 4, to += 3) {
    const std::array<std::uint32_t, 4> values{kValues[byte_of(from[0])], kValues[byte_of(from[1])],
                                              kValues[byte_of(from[2])], kValues[byte_of(from[3])]};
    seen |= values[0] | values[1] | values[2] | values[3];
    const std::uint32_t bits = values[0] << 18U | values[1] << 12U | values[2] << 6U | values[3];
    to[0] = static_cast<char>(bits >> 16U & 0xFFU);
    to[1] = static_cast<char>(bits >> 8U & 0xFFU);
    to[2] = static_cast<char>(bits & 0xFFU);
  }
  if ((seen & kNone) != 0) return false;
  const std::size_t rest = bytes.size() - 3 * whole;
  if (rest == 0) return true;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t value = kValues[byte_of(from[i])];
    // padding is allowed only after the characters that the bytes need
    if (value == kNone && (from[i] != '=' || i <= rest)) return false;
    bits = (bits << 6U) | (value & 63U);
  }
  for (std::size_t i = 0; i < rest; ++i) to[i] = static_cast<char>((bits >> (16U - 8U * i)) & 0xFFU);
  return true;
}

}  // namespace meshorder
