// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/base64.hpp"

namespace meshorder {

std::string Base64Encoder::put(std::span<const char> bytes) {
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (const char byte : bytes) {
    packed_ = (packed_ << 8U) | static_cast<unsigned char>(byte);
    if (++held_ == 3) flush(text);
  }
  return text;
}

std::string Base64Encoder::finish() {
  std::string text;
  if (held_ == 0) return text;
  const unsigned missing = 3 - held_;
  packed_ <<= 8U * missing;
  flush(text);
  return text.replace(4 - missing, missing, missing, '=');
}

void Base64Encoder::flush(std::string& text) {
  for (const unsigned shift : {18U, 12U, 6U, 0U}) text += kBase64Alphabet[(packed_ >> shift) & 63U];
  packed_ = 0;
  held_ = 0;
}

std::string to_base64(std::span<const char> bytes) {
  Base64Encoder encoder;
  std::string text = encoder.put(bytes);
  return text += encoder.finish();
}

}  // namespace meshorder
