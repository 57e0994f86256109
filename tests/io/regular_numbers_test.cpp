// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/regular_text.hpp"
#include "support/files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;

constexpr std::string_view kSeparators = " \t\r\n";

/// Reads one word after another.
template <class Number>
RegularNumbers read_words(std::string_view text, std::vector<Number>& values) {
  RegularNumbers read;
  while (read.count < values.size()) {
    const std::size_t begin = text.find_first_not_of(kSeparators, read.bytes);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(kSeparators, begin), text.size());
    Number value{};
    const auto [after, code] = std::from_chars(text.data() + begin, text.data() + end, value);
    if (code != std::errc{} || after != text.data() + end) break;
    values[read.count++] = value;
    read.bytes = end;
  }
  return read;
}

template <class Number>
void expect_alike(const std::string& text, std::size_t most) {
  std::vector<Number> expected(most);
  const RegularNumbers words = read_words(text, expected);
  expected.resize(words.count);
  for (std::size_t part = 1; part <= text.size() + 1; ++part) {
    std::vector<Number> values(most);
    const RegularNumbers read = read_regular_numbers<Number>(text, values, part);
    values.resize(read.count);
    EXPECT_EQ(values, expected) << text << " in parts of " << part;
    // only blanks may be between the last number and the end
    const std::string_view rest = std::string_view(text).substr(words.bytes, read.bytes - words.bytes);
    EXPECT_GE(read.bytes, words.bytes) << text << " in parts of " << part;
    EXPECT_EQ(rest.find_first_not_of(kSeparators), std::string_view::npos) << text;
  }
}

TEST(RegularNumbers, AreReadAsOneAfterAnotherHoweverTheTextIsDivided) {
  const std::string gap(300, ' ');
  for (const std::string& text : {std::string(),
                                  std::string(" \n"),
                                  std::string("1"),
                                  std::string("1 2 3\n4 5\n\n6\t7\r\n8 9 12345678 123456789\n"),
                                  std::string("7 -8 255 256 -129 300 1\n"),
                                  std::string("1 2 +3 4 5\n"),
                                  std::string("1 2 3x 4\n"),
                                  std::string("1 2\f3 4\n"),
                                  std::string("1 \f 2\n"),
                                  std::string("1 2\0003 4\n", 8),
                                  std::string("1\0012 3\n"),
                                  std::string("1 2 99999999999999999999 3"),
                                  std::string("1.5 -2e3 1e-400 4 5"),
                                  std::string("inf -inf 1 2"),
                                  std::string("1e999 2"),
                                  "1 2" + gap + "3 4" + gap,
                                  gap + "5" + gap + "x",
                                  std::string("1 2 POINT_DATA 3\n"),
                                  std::string("0.1 0.2 0.30000000000000004\n"),
                                  std::string("1 2 \303\251 3\n")}) {
    for (const std::size_t most : {0U, 1U, 2U, 3U, 7U, 100U}) {
      expect_alike<std::uint8_t>(text, most);
      expect_alike<std::int32_t>(text, most);
      expect_alike<std::int64_t>(text, most);
      expect_alike<float>(text, most);
    }
  }
}

TEST(RegularNumbers, OfOtherTypesAreLeftToTheCaller) {
  std::vector<std::uint16_t> values(2);
  EXPECT_EQ(read_regular_numbers<std::uint16_t>("1 2", values).count, 0U);
}

TEST(RegularNumbers, MoveAScannerToItsLine) {
  const TemporaryFolder folder;
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const auto path = folder.file("numbers", "head" + end + "1 2" + end + end + "3 x" + end);
    Scanner in{FilePath(path)};
    in.rest_of_line();
    std::vector<std::int32_t> values(5);
    EXPECT_EQ(read_regular_numbers<std::int32_t>(in, values), 3U);
    EXPECT_EQ(in.word("a word"), "x");
    EXPECT_EQ(in.line(), 4);
  }
}

TEST(RegularNumbers, AreCountedAsWords) {
  EXPECT_EQ(count_words(""), 0U);
  EXPECT_EQ(count_words("  \n"), 0U);
  std::string text;
  for (std::size_t words = 1; words < 40; ++words) {
    text += std::string(words % 3 + 1, ' ') + std::string(words % 11 + 1, words % 2 == 0 ? '!' : '\377');
    EXPECT_EQ(count_words(text), words);
    EXPECT_EQ(count_words(text + "\n"), words);
  }
}

}  // namespace
}  // namespace meshorder
