// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/scanner.hpp"

#include "support/files.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
