// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace meshorder {

inline constexpr std::string_view kBase64Alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Returns the number of characters that encode `bytes` bytes, with padding.
constexpr std::uint64_t base64_length(std::uint64_t bytes) { return (bytes + 2) / 3 * 4; }

/// Encodes bytes as base64 (RFC 4648), part by part.
class Base64Encoder {
 public:
  /// Returns the characters that these bytes complete.
  [[nodiscard]] std::string put(std::span<const char> bytes);
  /// Returns the padded characters of the last one or two bytes; empty if no bytes are left.
  [[nodiscard]] std::string finish();

 private:
  std::uint32_t packed_ = 0;
  unsigned held_ = 0;
};

std::string to_base64(std::span<const char> bytes);

/// Decodes the beginning of a text until `bytes` is full. Returns false if the text is too short or has a
/// wrong character; `bytes` is then undefined.
[[nodiscard]] bool from_base64(std::string_view text, std::span<char> bytes);

}  // namespace meshorder
