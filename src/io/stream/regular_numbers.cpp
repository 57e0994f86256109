// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "io/stream/regular_text.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <system_error>
#include <vector>

namespace meshorder {
namespace {

constexpr std::size_t kMostParts = 64;
constexpr std::size_t kNumberBytes = 24;  // assumed bytes of a number, to choose how much text to examine

bool is_separator(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

/// Returns how many words begin in a text that follows a separator. Handles eight bytes at a time: in
/// `of_words`, the highest bit of each byte says whether the byte is above the space.
std::size_t words_in(std::string_view text) {
  constexpr std::uint64_t kOnes = 0x0101010101010101U;
  constexpr std::uint64_t kHighest = kOnes * 0x80U;
  std::size_t words = 0;
  std::uint64_t before = 0;  // not 0 if the previous byte belongs to a word
  std::size_t at = 0;
  if constexpr (std::endian::native == std::endian::little) {
    for (; at + 8 <= text.size(); at += 8) {
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, text.data() + at, sizeof(bytes));
      const std::uint64_t of_words = (bytes | ((bytes & ~kHighest) + kOnes * 0x5FU)) & kHighest;
      const std::uint64_t starts = (of_words & ~(of_words << 8U | before)) >> 7U;
      words += starts * kOnes >> 56U;  // the sum of the bytes of `starts`
      before = of_words >> 56U;
    }
  }
  for (; at < text.size(); ++at) {
    const bool of_word = static_cast<unsigned char>(text[at]) > ' ';
    words += of_word && before == 0 ? 1U : 0U;
    before = of_word ? 1 : 0;
  }
  return words;
}

/// Reads the word at `at` if all of it is a number. Returns the word's end, else null.
template <class Number>
const char* read_number(const char* at, const char* end, Number& value) {
  if constexpr (std::is_integral_v<Number>) {
    if (end - at > 8) {
      const Digits digits = leading_digits(at);
      if (digits.count > 0 && digits.count < 8 && digits.count <= std::numeric_limits<Number>::digits10 &&
          is_separator(at[digits.count])) {
        value = static_cast<Number>(digits.number);
        return at + digits.count;
      }
    }
  }
  const auto [after, code] = std::from_chars(at, end, value);
  return code == std::errc{} && (after == end || is_separator(*after)) ? after : nullptr;
}

/// Divides the text from `begin` to about `end` into at most `kMostParts` parts. Each part ends after a
/// separator or with the text.
std::vector<std::string_view> divided_at_blanks(std::string_view text, std::size_t begin, std::size_t end,
                                                std::size_t part_bytes) {
  std::vector<std::string_view> parts;
  while (parts.size() < kMostParts && begin < end) {
    std::size_t stop = std::min(begin + part_bytes, end);
    while (stop < text.size() && !is_separator(text[stop - 1])) ++stop;
    parts.push_back(text.substr(begin, stop - begin));
    begin = stop;
  }
  return parts;
}

/// Returns the number of words before each part, then the number of all words.
std::vector<std::size_t> first_words(const std::vector<std::string_view>& parts) {
  std::vector<std::size_t> first(parts.size() + 1, 0);
  for_each_chunk(index_size(parts), 1,
                 [&](Index k, Index, Index) { first[static_cast<std::size_t>(k) + 1] = words_in(parts[k]); });
  std::partial_sum(first.begin(), first.end(), first.begin());
  return first;
}

/// Reads numbers until `values` is full or a word is no number. If only separators follow these numbers, the
/// result's `bytes` is the size of the part.
template <class Number>
RegularNumbers read_part(std::string_view part, std::span<Number> values) {
  RegularNumbers read;
  const char* const end = part.data() + part.size();
  const char* at = part.data();
  std::int64_t lines = 0;
  const auto skip_separators = [&] {
    for (; at < end && is_separator(*at); ++at) {
      lines += *at == '\n' ? 1 : 0;
      if (*at == '\r') read.has_returns = true;
    }
  };
  for (; read.count < values.size(); ++read.count) {
    skip_separators();
    const char* const after = read_number(at, end, values[read.count]);
    if (after == nullptr) return read;
    at = after;
    read.bytes = static_cast<std::size_t>(at - part.data());
    read.lines = lines;
  }
  skip_separators();  // there may be bytes that are neither separators nor words
  if (at < end) return read;
  read.bytes = part.size();
  read.lines = lines;
  return read;
}

/// Reads up to `count` numbers of a text. `read_one(part, first, n)` reads the n numbers of a part; the first
/// of them is number `first` of the text.
RegularNumbers read_parts(std::string_view text, std::size_t count, std::size_t part_bytes,
                          const std::function<RegularNumbers(std::string_view part, std::size_t first,
                                                             std::size_t count)>& read_one) {
  RegularNumbers read;
  while (read.count < count) {
    const std::size_t before = read.count;
    const std::size_t left = count - before;
    const std::size_t end =
        left < (text.size() - read.bytes) / kNumberBytes ? read.bytes + left * kNumberBytes : text.size();
    const std::vector<std::string_view> parts = divided_at_blanks(text, read.bytes, end, part_bytes);
    if (parts.empty()) break;
    const std::vector<std::size_t> first = first_words(parts);
    std::vector<RegularNumbers> of_part(parts.size());
    for_each_chunk(index_size(parts), 1, [&](Index k, Index, Index) {
      const std::size_t begin = std::min(first[k], left);
      of_part[k] = read_one(parts[k], before + begin, std::min(first[k + 1], left) - begin);
    });
    for (std::size_t k = 0; k < parts.size() && read.count < count; ++k) {
      const RegularNumbers& own = of_part[k];
      read.count += own.count;
      read.bytes += own.bytes;
      read.lines += own.lines;
      read.has_returns = read.has_returns || own.has_returns;
      if (own.bytes < parts[k].size()) return read;
    }
  }
  return read;
}

}  // namespace

std::size_t count_words(std::string_view text) {
  constexpr std::size_t kPartBytes = std::size_t{1} << 22;
  std::size_t words = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::vector<std::string_view> parts = divided_at_blanks(text, begin, text.size(), kPartBytes);
    for (const std::string_view part : parts) begin += part.size();
    words += first_words(parts).back();
  }
  return words;
}

template <class Number>
RegularNumbers read_numbers_of_type(std::string_view text, std::span<Number> values, std::size_t part_bytes) {
  return read_parts(text, values.size(), part_bytes,
                    [&](std::string_view part, std::size_t first, std::size_t count) {
                      return read_part(part, values.subspan(first, count));
                    });
}

template RegularNumbers read_numbers_of_type(std::string_view, std::span<double>, std::size_t);
template RegularNumbers read_numbers_of_type(std::string_view, std::span<float>, std::size_t);
template RegularNumbers read_numbers_of_type(std::string_view, std::span<std::uint8_t>, std::size_t);
template RegularNumbers read_numbers_of_type(std::string_view, std::span<std::int32_t>, std::size_t);
template RegularNumbers read_numbers_of_type(std::string_view, std::span<std::int64_t>, std::size_t);

}  // namespace meshorder
