// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/npy.hpp"

#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

namespace meshorder {
namespace {

using namespace std::string_literals;
using test::TemporaryFolder;

/// A NumPy file with that header and those bytes after it.
std::string npy(const std::string& header, const std::string& data) {
  const auto length = static_cast<char>(header.size());
  return "\x93NUMPY\x01\0"s + std::string{length, '\0'} + header + data;
}

TEST(Npy, WritesWhatNumpyLoads) {
  const TemporaryFolder folder;
  const std::vector<std::int32_t> values{3, -1};
  write_npy(values, folder.path() / "a.npy");
  const std::string content = test::content_of(folder.path() / "a.npy");
  EXPECT_EQ(content.substr(0, 8), "\x93NUMPY\x01\0"s);
  EXPECT_EQ(content.substr(10, 58), "{'descr': '<i4', 'fortran_order': False, 'shape': (2,), } ");
  EXPECT_EQ((content.size() - 8) % 64, 0U);
  EXPECT_EQ(content.substr(content.size() - 9), "\n\3\0\0\0\xff\xff\xff\xff"s);
}

TEST(Npy, ReadsBackBothWidths) {
  const TemporaryFolder folder;
  const std::vector<std::int64_t> wide{1, -(std::int64_t{1} << 40)};
  write_npy(wide, folder.path() / "a.npy");
  EXPECT_EQ(read_npy(folder.path() / "a.npy"), wide);
  write_npy(std::vector<std::int32_t>{}, folder.path() / "b.npy");
  EXPECT_TRUE(read_npy(folder.path() / "b.npy").empty());
}

TEST(Npy, ReadsBigEndianNumbers) {
  const TemporaryFolder folder;
  const auto path =
      folder.file("a.npy", npy("{'descr': '>u4', 'fortran_order': False, 'shape': (1,), }\n", "\0\0\1\2"s));
  EXPECT_EQ(read_npy(path), std::vector<std::int64_t>{258});
}

TEST(Npy, RefusesWhatIsNoListOfIntegers) {
  const TemporaryFolder folder;
  const std::string start = "{'descr': '<i4', 'fortran_order': False, 'shape': ";
  const std::vector<std::string> broken{
      "not a NumPy file",
      npy(start + "(2, 2), }\n", std::string(16, '\0')),
      npy(start + "(1000000000000,), }\n", "\0\0\0\0"s),
      npy(start + "(2,), }\n", "\0\0\0\0"s),
      npy(start + "(-1,), }\n", ""),
      npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }\n", std::string(8, '\0')),
      npy("{'fortran_order': False, 'shape': (1,), }\n", std::string(8, '\0')),
      "\x93NUMPY\x01\0\xff\xff"s,
  };
  for (const std::string& content : broken) {
    EXPECT_THROW((void)read_npy(folder.file("a.npy", content)), InputError) << content;
  }
}

}  // namespace
}  // namespace meshorder
