// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/scanner.hpp"

#include "support/files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;

TEST(Scanner, CountsLinesWhateverTheirEnds) {
  const TemporaryFolder folder;
  Scanner scanner(folder.file("a.txt", "1\n2\r\n3\r4 # rest\n\n5"), '#');
  for (const int line : {1, 2, 3, 4, 6}) {
    scanner.integer<int>("a number");
    EXPECT_EQ(scanner.line(), line);
  }
  EXPECT_TRUE(scanner.at_end());
}

TEST(Scanner, ReadsNumbersAsPeopleWriteThem) {
  const TemporaryFolder folder;
  Scanner scanner(folder.file("a.txt", "+1 -2.5e3 1.0D2 1e-999 nan"));
  EXPECT_EQ(scanner.integer<int>("n"), 1);
  EXPECT_EQ(scanner.real("x"), -2500.0);
  EXPECT_EQ(scanner.real("x"), 100.0);
  EXPECT_EQ(scanner.real("x"), 0.0);
  EXPECT_TRUE(std::isnan(scanner.real("x")));
}

TEST(Digits, ArePutAllAtOnce) {
  std::vector<std::uint32_t> numbers{0, 99'999'999};
  for (std::uint32_t power = 1; power < kDigitsAtOnce; power *= 10) {
    for (std::uint32_t digit = 1; digit < 10; ++digit) {
      for (const std::uint32_t by : {0U, 1U, 7U})
        numbers.push_back(digit * power - std::min(by, digit * power));
    }
  }
  for (std::uint32_t k = 0; k < 200'000; ++k) numbers.push_back(k * 2654435761U % kDigitsAtOnce);
  for (const std::uint32_t number : numbers) {
    std::array<char, 8> text{};
    ASSERT_EQ(std::string(text.data(), put_digits(text.data(), number)), std::to_string(number));
  }
}

TEST(Digits, AreReadAllAtOnce) {
  for (const std::string number : {"0", "7", "42", "007", "1234", "98765", "999999", "1234567", "0000001"}) {
    for (const char behind : {' ', '\n', '\r', '\0', '/', ':', '.', '-', '\x7f', '\x80', '\xb0', '\xff'}) {
      const Digits digits = leading_digits((number + behind + "12345678").c_str());
      EXPECT_EQ(digits.count, static_cast<int>(number.size()));
      EXPECT_EQ(digits.number, static_cast<std::uint32_t>(std::stoul(number)));
    }
  }
  EXPECT_EQ(leading_digits("12345678").count, 8);
  EXPECT_EQ(leading_digits("-1234567").count, 0);
}

TEST(Scanner, ReadsWholeNumbersOfAnyLength) {
  const TemporaryFolder folder;
  std::string text;
  std::vector<std::int64_t> numbers;
  for (std::int64_t number = 1; number < 1'000'000'000'000'000'000; number = 7 * number / 3 + 1) {
    numbers.push_back(number);
    text += std::to_string(number) + (numbers.size() % 5 == 0   ? "\r\n"
                                      : numbers.size() % 3 == 0 ? "\t"
                                                                : " ");
  }
  Scanner scanner(folder.file("a.txt", text + "12345"));
  for (const std::int64_t number : numbers) EXPECT_EQ(scanner.integer<std::int64_t>("n"), number);
  EXPECT_EQ(scanner.integer<std::int64_t>("n"), 12345);
  EXPECT_THROW(scanner.integer<std::int64_t>("n"), InputError);
  EXPECT_THROW(Scanner(folder.file("b.txt", "123x567 890")).integer<std::int64_t>("n"), InputError);
  EXPECT_THROW(Scanner(folder.file("c.txt", "99999999999 1")).integer<std::int32_t>("n"), InputError);
}

TEST(Scanner, ErrorsNameFileLineAndRemedy) {
  const TemporaryFolder folder;
  Scanner scanner(folder.file("a.txt", "1\nx"));
  scanner.integer<int>("n");
  try {
    scanner.integer<int>("the count");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              (folder.path() / "a.txt").string() + ":2: the count is 'x'; a whole number is needed");
  }
}

TEST(Scanner, DoesNotBelieveCountsThatTheFileCannotHold) {
  const TemporaryFolder folder;
  Scanner scanner(folder.file("a.txt", "1000000000000 -1 99 2\n1 2"));
  EXPECT_THROW(scanner.count("nodes", 2), InputError);
  EXPECT_THROW(scanner.count("nodes", 2), InputError);
  EXPECT_THROW(scanner.count("nodes", 2), InputError);
  EXPECT_EQ(scanner.count("nodes", 2), 2);
}

TEST(Scanner, CountsPositionsFromZero) {
  const TemporaryFolder folder;
  Scanner scanner(folder.file("a.txt", "1 4 0 5"));
  EXPECT_EQ(scanner.position("a vertex", 4), 0);
  EXPECT_EQ(scanner.position("a vertex", 4), 3);
  EXPECT_THROW(scanner.position("a vertex", 4), InputError);
  EXPECT_THROW(scanner.position("a vertex", 4), InputError);
}

TEST(Scanner, CountsTheWordsOfALine) {
  const TemporaryFolder folder;
  Scanner scanner(folder.file("a.txt", "one \ttwo\fthree # four\n# none\n"), '#');
  EXPECT_EQ(scanner.words_in_line(), 3);
  (void)scanner.word("a word");
  EXPECT_EQ(scanner.words_in_line(), 2);
  (void)scanner.raw_line();
  EXPECT_EQ(scanner.words_in_line(), 0);
}

TEST(Scanner, RefusesFoldersEmptyAndMissingFiles) {
  const TemporaryFolder folder;
  EXPECT_THROW(Scanner(folder.path()), InputError);
  EXPECT_THROW(Scanner(folder.path() / "none"), InputError);
  EXPECT_THROW(Scanner(folder.file("a.txt", "")), InputError);
}

TEST(Scanner, ReadsBinaryInEitherOrder) {
  const TemporaryFolder folder;
  Scanner scanner(folder.file("a.bin", std::string_view("\0\0\0\1\1\0\0\0\7", 9)));
  EXPECT_EQ(scanner.binary<std::int32_t>("n", std::endian::big), 1);
  EXPECT_EQ(scanner.binary<std::int32_t>("n", std::endian::little), 1);
  EXPECT_THROW(scanner.binary<std::int32_t>("n"), InputError);
}

}  // namespace
}  // namespace meshorder
