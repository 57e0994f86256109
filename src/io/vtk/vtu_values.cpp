// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Arrays of .vtu files: text, base64 and raw bytes, plain or in compressed blocks.
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "io/stream/base64.hpp"
#include "io/stream/byte_order.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/regular_text.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include "io/vtk/vtu_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

namespace meshorder::vtk {

/// Location of the bytes of an array.
struct VtuDocument::Stored {
  std::uint64_t size = 0;                 // uncompressed, in bytes
  std::string decoded;                    // the decoded bytes if the file has base64
  std::string_view bytes;                 // all blocks, or the plain bytes
  std::vector<std::uint64_t> compressed;  // size of each block in bytes
  std::vector<std::uint64_t> uncompressed;
};

VtuEncoding::Mode VtuDocument::mode(const VtuElement& array) const {
  const std::string* format = array.attribute("format");
  if (format == nullptr || *format == "ascii") return VtuEncoding::Mode::ascii;
  if (*format == "binary") return VtuEncoding::Mode::base64;
  if (*format != "appended")
    throw error(array, "the format is '" + format->substr(0, 40) + "'",
                "ascii, binary or appended is needed");
  if (!appended_)
    throw error(array, "the array is appended, but <AppendedData> is missing", "the file may be cut short");
  return appended_base64_ ? VtuEncoding::Mode::appended_base64 : VtuEncoding::Mode::appended_raw;
}

/// Decodes `bytes` bytes from the beginning of `text`.
std::string VtuDocument::base64(const VtuElement& array, std::string_view text, std::uint64_t bytes) const {
  if (base64_length(bytes) > text.size())
    throw error(array, "the array's bytes end early", "the file may be cut short");
  std::string result;
  resize_large(result, bytes);
  if (!from_base64(text, result))
    throw error(array, "the array is not base64", "letters, digits, + and / are needed");
  return result;
}

std::uint64_t VtuDocument::header_word(std::string_view bytes, std::size_t index) const {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < header_size(); ++i) {
    const std::size_t place = encoding_.order == std::endian::big ? i : header_size() - 1 - i;
    value = (value << 8U) | static_cast<unsigned char>(bytes[index * header_size() + place]);
  }
  return value;
}

void VtuDocument::claim(const VtuElement& array, std::uint64_t bytes) const {
  const std::string* const name = array.attribute("Name");
  const std::string fault = refused_claim(
      bytes, name == nullptr ? "the array" : fmt::format("the array '{}'", name->substr(0, 40)));
  if (!fault.empty()) throw error(array, fault, kClaimRemedy);
}

VtuDocument::Stored VtuDocument::locate(const VtuElement& array) const {
  const VtuEncoding::Mode how = mode(array);
  std::string_view data = array.text;
  if (how == VtuEncoding::Mode::base64) {
    data.remove_prefix(std::min(data.find_first_not_of(kXmlBlanks), data.size()));
  } else {
    const auto offset =
        static_cast<std::size_t>(count(array, "offset", std::numeric_limits<std::int64_t>::max()));
    if (offset > appended_->size()) {
      throw error(array, fmt::format("the offset {} lies beyond the file", offset),
                  "the file may be cut short");
    }
    data = appended_->substr(offset);
  }

  Stored stored;
  const bool coded = how != VtuEncoding::Mode::appended_raw;
  if (const auto kind = encoding_.compressor; kind != VtuEncoding::Compressor::none) {
    if (!VtuCompressor::available(kind)) {
      throw Unavailable(
          error(array,
                fmt::format("the array is compressed by {}, which this build of meshorder lacks",
                            VtuCompressor::library(kind)),
                fmt::format("build it with {}=ON, or write the file without compression",
                            VtuCompressor::option(kind)))
              .what());
    }
    locate_blocks(array, data, coded, stored);
    return stored;
  }
  // the data are a word with the number of bytes, then the bytes
  const std::string head =
      coded ? base64(array, data, header_size()) : std::string(data.substr(0, header_size()));
  if (head.size() < header_size())
    throw error(array, "the array's bytes end early", "the file may be cut short");
  stored.size = header_word(head, 0);
  if (stored.size > data.size())
    throw error(array,
                fmt::format("the array has {} bytes, but the file ends after {}", stored.size, data.size()),
                "the file may be cut short");
  if (coded) {
    stored.decoded = base64(array, data, header_size() + stored.size);
    stored.bytes = std::string_view(stored.decoded).substr(header_size());
  } else {
    stored.bytes = data.substr(header_size(), stored.size);
    if (stored.bytes.size() < stored.size)
      throw error(array, "the array's bytes end early", "the file may be cut short");
  }
  return stored;
}

/// Locates compressed blocks. The words of the header are: number of blocks, size of a block, size of the
/// last block (0 if full), compressed size of each block. The blocks follow.
void VtuDocument::locate_blocks(const VtuElement& array, std::string_view data, bool coded,
                                Stored& stored) const {
  const auto early = [&] { return error(array, "the array's bytes end early", "the file may be cut short"); };
  const auto take = [&](std::uint64_t bytes) {
    if (!coded && bytes > data.size()) throw early();
    return coded ? base64(array, data, bytes) : std::string(data.substr(0, bytes));
  };
  const std::string head = take(3 * header_size());
  const std::uint64_t blocks = header_word(head, 0);
  const std::uint64_t block_size = header_word(head, 1);
  const std::uint64_t last_size = header_word(head, 2);
  if (blocks == 0) return;
  if (blocks > data.size() / header_size()) throw early();
  const std::string sizes = take((3 + blocks) * header_size());
  data.remove_prefix(
      std::min<std::uint64_t>(coded ? base64_length(sizes.size()) : sizes.size(), data.size()));

  std::uint64_t compressed = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    stored.compressed.push_back(header_word(sizes, 3 + b));
    stored.uncompressed.push_back(b + 1 == blocks && last_size > 0 ? last_size : block_size);
    if (stored.compressed.back() > data.size() - compressed) throw early();
    compressed += stored.compressed.back();
    const std::uint64_t most =
        stored.compressed.back() * VtuCompressor::greatest_ratio(encoding_.compressor) + 1024;
    if (stored.uncompressed.back() > most) {
      throw error(array,
                  fmt::format("a block of {} bytes cannot hold {}", stored.compressed.back(),
                              stored.uncompressed.back()),
                  "the array is damaged");
    }
    stored.size += stored.uncompressed.back();
  }
  if (coded) {
    stored.decoded = base64(array, data, compressed);
    stored.bytes = stored.decoded;
  } else {
    stored.bytes = data.substr(0, compressed);
  }
}

namespace {

/// Returns for each number the sum of the numbers before it.
std::vector<std::uint64_t> sums_before(const std::vector<std::uint64_t>& numbers) {
  std::vector<std::uint64_t> sums(numbers.size());
  std::exclusive_scan(numbers.begin(), numbers.end(), sums.begin(), std::uint64_t{0});
  return sums;
}

}  // namespace

/// Copies the uncompressed bytes to `target`.
void VtuDocument::copy(const VtuElement& array, const Stored& stored, char* target) const {
  if (stored.compressed.empty()) {
    if (!stored.bytes.empty()) std::memcpy(target, stored.bytes.data(), stored.bytes.size());
    return;
  }
  const VtuCompressor compressor(encoding_.compressor);
  const std::vector<std::uint64_t> from = sums_before(stored.compressed);
  const std::vector<std::uint64_t> to = sums_before(stored.uncompressed);
  std::vector<std::uint8_t> is_sound(from.size(), 0);
  parallel_loop(from.size(), [&](std::size_t b) {
    const auto size = static_cast<std::size_t>(stored.compressed[b]);
    const auto whole_size = static_cast<std::size_t>(stored.uncompressed[b]);
    is_sound[b] =
        compressor.uncompress({stored.bytes.data() + from[b], size}, {target + to[b], whole_size}) ? 1 : 0;
  });
  const auto damaged = std::find(is_sound.begin(), is_sound.end(), 0) - is_sound.begin();
  if (std::cmp_less(damaged, is_sound.size()))
    throw error(array, fmt::format("block {} cannot be uncompressed", damaged), "the array is damaged");
}

template <class Number>
std::vector<Number> VtuDocument::words(const VtuElement& array, std::int64_t count) const {
  std::string_view text = array.text;
  std::vector<Number> result;
  resize_large(result, std::min<std::size_t>(static_cast<std::size_t>(count), text.size() / 2 + 1));
  const RegularNumbers regular = read_regular_numbers<Number>(text, result);
  result.resize(regular.count);
  text.remove_prefix(regular.bytes);
  while (true) {
    std::string_view word = next_word(text, kXmlBlanks);
    if (word.empty()) break;
    const auto broken = [&] {
      const auto byte = static_cast<std::size_t>(word.data() - scanner_.all().data());
      return error_at(byte, "a value is '" + std::string(word.substr(0, 40)) + "'",
                      fmt::format("the array's type is {}", required(array, "type")));
    };
    if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
    Number value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = end == word.data() + word.size();
    // a number that is too small for its type counts as 0
    const bool tiny = std::is_floating_point_v<Number> && code == std::errc::result_out_of_range && whole &&
                      word.find_first_of("eE") != std::string_view::npos &&
                      word[word.find_first_of("eE") + 1] == '-';
    if (!whole || (code != std::errc{} && !tiny)) throw broken();
    if (std::cmp_equal(result.size(), count)) {
      throw error_at(static_cast<std::size_t>(word.data() - scanner_.all().data()),
                     fmt::format("the array has more than {} values", count),
                     "the counts of its piece say how many there are");
    }
    result.push_back(value);
  }
  if (std::cmp_not_equal(result.size(), count))
    throw error(array, fmt::format("the array has {} values", result.size()),
                fmt::format("{} are needed", count));
  return result;
}

template <class Number>
std::vector<Number> VtuDocument::numbers(const VtuElement& array, std::int64_t count) const {
  if (mode(array) == VtuEncoding::Mode::ascii) return words<Number>(array, count);
  const Stored stored = locate(array);
  claim(array, stored.size);
  if (stored.size % sizeof(Number) != 0 || std::cmp_not_equal(stored.size / sizeof(Number), count)) {
    throw error(array, fmt::format("the array has {} bytes", stored.size),
                fmt::format("{} values of {} bytes are needed", count, sizeof(Number)));
  }
  std::vector<Number> result;
  resize_large(result, static_cast<std::size_t>(count));
  copy(array, stored, reinterpret_cast<char*>(result.data()));
  if (encoding_.order != std::endian::native) {
    for (Number& number : result) number = swapped_bytes(number);
  }
  return result;
}

/// Reads the bits of an array of type Bit: eight in a byte, the highest first; in text, one number for each
/// bit.
std::vector<std::uint8_t> VtuDocument::bits(const VtuElement& array, std::int64_t count) const {
  if (mode(array) == VtuEncoding::Mode::ascii) return words<std::uint8_t>(array, count);
  const std::vector<std::uint8_t> packed = numbers<std::uint8_t>(array, (count + 7) / 8);
  claim(array, static_cast<std::uint64_t>(count));
  std::vector<std::uint8_t> result(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (packed[i / 8] >> (7 - i % 8)) & 1U;
  return result;
}

/// Reads strings that end with a zero byte.
std::vector<std::string> VtuDocument::strings(const VtuElement& array, std::int64_t count) const {
  std::string bytes;
  if (mode(array) == VtuEncoding::Mode::ascii) {
    // texts are given by the codes of their characters
    std::string_view text = array.text;
    for (std::string_view word = next_word(text, kXmlBlanks); !word.empty();
         word = next_word(text, kXmlBlanks)) {
      int code = 0;
      const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), code);
      if (failed != std::errc{} || end != word.data() + word.size() || code < -128 || code > 255)
        throw error(array, "a text holds '" + std::string(word.substr(0, 40)) + "'",
                    "texts are numbers of characters, each text ends with 0");
      bytes += static_cast<char>(code);
    }
  } else {
    const Stored stored = locate(array);
    claim(array, stored.size);
    bytes.resize(stored.size);
    copy(array, stored, bytes.data());
  }
  if (std::cmp_not_equal(std::count(bytes.begin(), bytes.end(), '\0'), count) ||
      (!bytes.empty() && bytes.back() != '\0')) {
    throw error(array, fmt::format("the array has {} texts", std::count(bytes.begin(), bytes.end(), '\0')),
                fmt::format("{} are needed, each ends with 0", count));
  }
  std::vector<std::string> result;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = bytes.find('\0', begin);
    result.push_back(bytes.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

/// Returns an empty vector of the array's number type.
Values VtuDocument::no_values(const VtuElement& array) const {
  const std::string& type = required(array, "type");
  if (array.number_type() == kXmlTypeNames.size())
    throw error(array, "the type is '" + type.substr(0, 40) + "'",
                "Int8 … UInt64, Float32, Float64 or String is needed");
  return values_of_type(array.number_type());
}

std::int64_t VtuDocument::value_count(const VtuElement& array) const {
  if (mode(array) == VtuEncoding::Mode::ascii) return static_cast<std::int64_t>(count_words(array.text));
  const std::uint64_t size = locate(array).size;
  return std::visit(
      [&](const auto& list) {
        using Number = typename std::decay_t<decltype(list)>::value_type;
        return static_cast<std::int64_t>(size / sizeof(Number));
      },
      no_values(array));
}

Values VtuDocument::values(const VtuElement& array, std::int64_t count) const {
  if (required(array, "type") == "Bit") return bits(array, count);
  Values values = no_values(array);
  std::visit(
      [&](auto& result) {
        using Number = typename std::decay_t<decltype(result)>::value_type;
        if constexpr (std::is_same_v<Number, std::string>) {
          result = strings(array, count);
        } else {
          result = numbers<Number>(array, count);
        }
      },
      values);
  return values;
}

}  // namespace meshorder::vtk
