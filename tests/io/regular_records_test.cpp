// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "io/stream/regular_text.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;

constexpr Index kRecords = 6;

/// The result of a reader: its numbers, the rest of the text, or an error.
struct Outcome {
  std::vector<int> numbers = {};
  std::string rest = {};
  std::string fault = {};
};

/// Reads records of two numbers; the first `regular` records are already read.
Outcome read_rest(Scanner& in, Index regular, std::vector<int> numbers) {
  Outcome outcome{.numbers = std::move(numbers)};
  try {
    for (Index record = regular; record < kRecords; ++record) {
      if (in.at_end()) in.fail("no record", "");
      for (std::size_t k = 0; k < 2; ++k) {
        if (in.at_line_end()) in.fail("no number", "");
        outcome.numbers[2 * static_cast<std::size_t>(record) + k] = in.integer<int>("a number");
      }
      if (!in.at_line_end()) in.fail("a number too many", "");
    }
    if (!in.at_end()) outcome.rest = std::to_string(in.line()) + ": " + std::string(in.word("a word"));
  } catch (const Error& error) {
    outcome.fault = error.what();
  }
  return outcome;
}

TEST(RegularRecords, AreReadAsOneAfterAnotherHoweverTheTextIsDivided) {
  const TemporaryFolder folder;
  const std::string good = "head\n1 2\n3 4\n5 6\n7 8\n9 10\n11 12\ntail 1\nmore\n";
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<std::string> texts = {good,
                                          good.substr(0, good.find("\ntail")),
                                          with("3 4\n", "# none\n\n  3   4 # two\n\t\n"),
                                          with("3 4\n", "3 4\r\n\r\n"),
                                          with("3 4\n", "3 4\r"),
                                          with("3 4\n5 6\n", "3 4\r5 6\n\n"),
                                          with("3 4\n", "3\n4\n"),
                                          with("3 4\n5 6\n", "3 4 5 6\n"),
                                          with("3 4\n5 6\n", "3\n4\n5 6 7 8\n"),
                                          with("3 4\n", "3\n"),
                                          with("9 10\n", "9 10 11\n"),
                                          with("9 10\n", "9 x\n"),
                                          with("9 10\n", "9 +10\n"),
                                          with("9 10\n", "9 99999999999\n"),
                                          with("11 12\n", "11\n"),
                                          with("11 12\ntail", "11 12 tail"),
                                          with("1 2\n", "\f\n1 2\n"),
                                          with("1 2\n", "\n\n\n\n1 2\n"),
                                          with("3 4\n", "# a\r# b\n3 4\n"),
                                          with("9 10\n", "# a\r# b\n9 x\n"),
                                          with("3 4\n", "\v\n3\t4\n"),
                                          "head\n1 2\n3 4\r",
                                          "head\n",
                                          "head",
                                          "head\n1 2"};
  for (const std::string& text : texts) {
    const std::string file = folder.file("a.txt", text);
    Scanner strict(file, '#');
    (void)strict.word("the head");
    const Outcome expected = read_rest(strict, 0, std::vector<int>(2 * kRecords));
    for (std::size_t bytes = 1; bytes <= text.size() + 1; ++bytes) {
      Scanner in(file, '#');
      (void)in.word("the head");
      std::vector<int> numbers(2 * kRecords);
      const Index regular = read_regular_records(
          in, kRecords,
          [&](Scanner& part, Index record) {
            int* const at = numbers.data() + 2 * static_cast<std::ptrdiff_t>(record);
            return part.take_number(at[0]) && part.take_number(at[1]);
          },
          bytes);
      EXPECT_TRUE(text != good || regular == kRecords);
      std::fill(numbers.begin() + 2 * static_cast<std::ptrdiff_t>(regular), numbers.end(), 0);
      const Outcome outcome = read_rest(in, regular, std::move(numbers));
      EXPECT_EQ(outcome.fault, expected.fault) << text << "in parts of " << bytes;
      EXPECT_EQ(outcome.rest, expected.rest) << text << "in parts of " << bytes;
      EXPECT_EQ(outcome.numbers, expected.numbers) << text << "in parts of " << bytes;
    }
  }
}

TEST(RegularRecords, StopAtTheSameErrorOnOneThread) {
  const TemporaryFolder folder;
  Scanner in(folder.file("a.txt", "1\n# none\n\n2 # two\n3 x\n4\n"), '#');
  std::vector<int> numbers(kRecords);
  const Index regular = in_arena({.threads = 1}, [&] {
    return read_regular_records(
        in, kRecords, [&](Scanner& part, Index record) { return part.take_number(numbers[record]); });
  });
  EXPECT_EQ(regular, 2);
  EXPECT_EQ(in.line(), 4);
  EXPECT_EQ(in.word("a word"), "3");
}

TEST(RegularRecords, MayHaveSeveralLines) {
  constexpr Index kOfThree = 4;
  const TemporaryFolder folder;
  const std::string good = "1\n2\n3\n# none\n4\n5\n6\n\n7\n8\n9\n10\n11\n12\n# none\ntail\n";
  const std::vector<int> expected = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  for (const std::string_view irregular : {"5\n", "5 ", "\n5\n", "5\n\n", "5\r"}) {
    const std::string text = std::string(good).replace(good.find("5\n"), 2, irregular);
    for (const int threads : {1, 2}) {
      for (std::size_t bytes = 1; bytes <= text.size() + 1; ++bytes) {
        Scanner in(folder.file("a.txt", text), '#');
        std::vector<int> numbers(expected.size());
        const auto read = [&](Scanner& part, Index record) {
          for (Index k = 0; k < 3; ++k) numbers[3 * record + k] = part.integer<int>("a number");
          return true;
        };
        const Index regular = in_arena({.threads = threads},
                                       [&] { return read_regular_records(in, kOfThree, read, bytes, 3); });
        EXPECT_TRUE(text != good || regular == kOfThree) << bytes;
        for (Index record = regular; record < kOfThree; ++record) read(in, record);
        EXPECT_EQ(numbers, expected) << irregular << " in parts of " << bytes;
        EXPECT_EQ(in.word("a word"), "tail");
        EXPECT_EQ(in.line(), std::count(text.begin(), text.end(), '\n') + (irregular == "5\r" ? 1 : 0));
      }
    }
  }
}

TEST(RegularLines, AreRecordsEvenIfTheyAreBlank) {
  const TemporaryFolder folder;
  const std::string text = "head\n1 2\n\n \t\n3\r\n\n4 5 x\n6\n";
  for (const int threads : {1, 2}) {
    for (std::size_t bytes = 1; bytes <= text.size() + 1; ++bytes) {
      Scanner in(folder.file("a.txt", text));
      (void)in.raw_line();
      std::vector<std::vector<int>> lines(8);
      const Index regular = in_arena({.threads = threads}, [&] {
        return read_regular_lines(
            in, 7,
            [&](Scanner& part, Index record) {
              lines[record].clear();
              while (!part.at_line_end()) lines[record].push_back(part.integer<int>("a number"));
              return true;
            },
            bytes);
      });
      // those before the fault that are in its part may be left
      ASSERT_LE(regular, 5);
      EXPECT_EQ(in.line(), 2 + regular);
      lines.resize(regular);
      const std::vector<std::vector<int>> all = {{1, 2}, {}, {}, {3}, {}};
      EXPECT_EQ(lines, std::vector(all.begin(), all.begin() + regular));
      EXPECT_TRUE(regular == 5 || (threads > 1 && bytes > 1)) << bytes;
    }
  }
}

TEST(RegularLines, EndWithTheText) {
  const TemporaryFolder folder;
  for (const std::string text : {"1\n\n2", "1\n\n2\n"}) {
    Scanner in(folder.file("a.txt", text));
    std::vector<int> numbers(9, 0);
    const Index regular = read_regular_lines(
        in, 9, [&](Scanner& part, Index record) { return record == 1 || part.take_number(numbers[record]); },
        1);
    EXPECT_EQ(regular, 3);
    EXPECT_EQ(in.bytes_left(), 0);
    EXPECT_EQ(numbers[2], 2);
  }
}

}  // namespace
}  // namespace meshorder
