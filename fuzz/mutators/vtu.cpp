// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Arrays of .vtu files in base64: decoded and uncompressed, changed, and encoded as they were.
#include "fuzz/families/families.hpp"
#include "fuzz/mutators/choice.hpp"
#include "io/stream/base64.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_compressor.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace meshorder::fuzz {
namespace {

constexpr std::uint64_t kMostOfArray = 1U << 20U;  // bytes

struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

bool is_base64(std::string_view text) {
  return text.find_first_not_of(kBase64Alphabet) == text.find_first_of('=') ||
         text.find_first_not_of(std::string(kBase64Alphabet) + '=') == std::string_view::npos;
}

/// Returns the places of base64 texts between tags.
std::vector<Span> encoded_texts(std::string_view input) {
  std::vector<Span> found;
  constexpr std::size_t kLeast = 8;
  for (std::size_t tag = input.find("binary\""); tag != std::string_view::npos;
       tag = input.find("binary\"", tag + 1)) {
    const std::size_t open = input.find('>', tag);
    if (open == std::string_view::npos) break;
    const std::size_t begin = input.find_first_not_of(" \t\r\n", open + 1);
    const std::size_t end = begin == std::string_view::npos ? begin : input.find_first_of(" \t\r\n<", begin);
    if (end == std::string_view::npos) break;
    if (end - begin >= kLeast && is_base64(input.substr(begin, end - begin))) found.push_back({begin, end});
  }
  return found;
}

/// Decodes groups of four characters up to the end or the first padding, and removes them from the text.
std::string decoded(std::string_view& text) {
  std::string bytes;
  while (text.size() >= 4) {
    std::uint32_t packed = 0;
    std::size_t padding = 0;
    for (const char c : text.substr(0, 4)) {
      const auto value = kBase64Alphabet.find(c);
      if (value == std::string_view::npos) ++padding;
      packed = packed << 6U | (value == std::string_view::npos ? 0U : static_cast<std::uint32_t>(value));
    }
    text.remove_prefix(4);
    for (std::size_t i = 0; i + padding < 3; ++i)
      bytes += static_cast<char>(packed >> (16U - 8U * i) & 0xFFU);
    if (padding > 0) break;
  }
  return bytes;
}

/// How arrays are stored.
struct Storage {
  std::size_t word = 4;  ///< bytes of a number in a header
  VtuEncoding::Compressor compressor = VtuEncoding::Compressor::none;

  explicit Storage(std::string_view input) {
    if (input.find("header_type=\"UInt64\"") != std::string_view::npos) word = 8;
    for (std::size_t k = 1; k < vtk::kCompressors.size(); ++k) {
      const auto kind = static_cast<VtuEncoding::Compressor>(k);
      if (input.find(vtk::kCompressors[k]) != std::string_view::npos && vtk::VtuCompressor::available(kind)) {
        compressor = kind;
      }
    }
  }

  [[nodiscard]] std::string header(const std::vector<std::uint64_t>& numbers) const {
    std::string bytes;
    for (const std::uint64_t number : numbers) {
      for (std::size_t i = 0; i < word; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFFU);
    }
    return bytes;
  }
  [[nodiscard]] std::uint64_t number(std::string_view bytes, std::size_t at) const {
    std::uint64_t value = 0;
    for (std::size_t i = word; i-- > 0;) {
      const std::size_t place = at * word + i;
      value = value << 8U | (place < bytes.size() ? static_cast<unsigned char>(bytes[place]) : 0U);
    }
    return value;
  }
};

/// Returns the uncompressed bytes of an array; nothing if the array is not whole.
std::optional<std::string> uncompressed_values(std::string_view text, const Storage& storage) {
  const std::string header = decoded(text);
  const std::uint64_t blocks = storage.number(header, 0);
  const std::uint64_t size = storage.number(header, 1);
  const std::uint64_t last = storage.number(header, 2);
  if (blocks == 0 || blocks > kMostOfArray || header.size() < (3 + blocks) * storage.word) return {};
  const std::string bytes = decoded(text);
  std::string values;
  std::size_t at = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t compressed = storage.number(header, 3 + b);
    const std::uint64_t plain = b + 1 == blocks && last != 0 ? last : size;
    if (compressed > bytes.size() - at || values.size() + plain > kMostOfArray || plain > kMostOfArray)
      return {};
    std::string block(plain, '\0');
    if (!vtk::VtuCompressor(storage.compressor).uncompress({bytes.data() + at, compressed}, block)) return {};
    values += block;
    at += compressed;
  }
  return values;
}

/// Returns an array with changed values in the same encoding; empty if the array cannot be decoded.
std::string changed_array(std::string_view text, const Storage& storage, Choice& choice) {
  constexpr std::size_t kGrowth = 64;
  const bool lies = choice.below(8) == 0;  // about the array's size
  const std::uint64_t beyond = lies ? choice.below(1024) : 0;
  if (storage.compressor == VtuEncoding::Compressor::none) {
    const std::string bytes = decoded(text);
    const std::string values =
        mutated_bytes(bytes.substr(std::min(storage.word, bytes.size())), bytes.size() + kGrowth);
    return to_base64(storage.header({values.size() + beyond}) + values);
  }
  std::optional<std::string> values = uncompressed_values(text, storage);
  if (!values) return {};
  const std::size_t most = values->size() + kGrowth;
  values = mutated_bytes(*std::move(values), most);
  const std::string block = vtk::VtuCompressor(storage.compressor).compress(*values);
  return to_base64(storage.header({1, values->size() + beyond, 0, block.size()})) + to_base64(block);
}

}  // namespace

std::string mutate_vtu(std::string input, std::uint32_t seed) {
  Choice choice(seed);
  const std::vector<Span> texts = encoded_texts(input);
  if (texts.empty()) return {};
  const Span chosen = texts[choice.below(texts.size())];
  const std::string fresh = changed_array(
      std::string_view(input).substr(chosen.begin, chosen.end - chosen.begin), Storage(input), choice);
  if (fresh.empty()) return {};
  return input.replace(chosen.begin, chosen.end - chosen.begin, fresh);
}

}  // namespace meshorder::fuzz
