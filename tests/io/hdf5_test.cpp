// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/session.hpp"
#include "io/hdf5/visitor.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace meshorder::hdf5 {
namespace {

TEST(Hdf5Visitor, BringsWhatTheWorkThrowsThroughTheLibrary) {
  const Session session;
  const File file = File::in_memory("", "new.h5");
  for (const char* name : {"a", "b", "c"}) {
    const Handle group(H5Gcreate2(file.id(), name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    ASSERT_TRUE(group.is_open());
  }
  std::vector<std::string> seen;
  Visitor<H5L_info_t> visitor([&](hid_t /*group*/, const char* name, const H5L_info_t& /*info*/) {
    seen.emplace_back(name);
    if (seen.size() == 2) throw std::length_error("two are enough");
  });
  EXPECT_LT(H5Literate(file.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, decltype(visitor)::visit, &visitor),
            0);
  EXPECT_THROW(visitor.rethrow(), std::length_error);
  EXPECT_EQ(seen, (std::vector<std::string>{"a", "b"}));
}

TEST(Hdf5File, ReplacesADatasetBesideOneWithTheNameThatItWouldTakeMeanwhile) {
  const Session session;
  File file = File::in_memory("", "new.h5");
  file.write("/a", Values(std::vector<double>{1, 2}), {2});
  file.write("/a.old", Values(std::vector<double>{7, 8, 9}), {3});
  file.write("/a", Values(std::vector<double>{3, 4, 5}), {3});
  file.write_texts("/t", std::vector<std::string>{"x"}, 4);
  file.write_texts("/t.old", std::vector<std::string>{"mine"}, 4);
  file.write_texts("/t", std::vector<std::string>{"y", "z"}, 4);
  EXPECT_EQ(file.names("/"), (std::vector<std::string>{"a", "a.old", "t", "t.old"}));
  EXPECT_EQ(file.read_texts("/t.old"), std::vector<std::string>{"mine"});
  EXPECT_EQ(file.read_texts("/t"), (std::vector<std::string>{"y", "z"}));
}

TEST(Hdf5File, RefusesAGroupWithinItself) {
  const Session session;
  std::string bytes;
  haddr_t at = 0;
  {
    const File file = File::in_memory("", "new.h5");
    const Handle group(H5Gcreate2(file.id(), "a", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    ASSERT_GE(H5Lcreate_hard(file.id(), "a", group.id(), "self", H5P_DEFAULT, H5P_DEFAULT), 0);
    EXPECT_TRUE(file.datasets().empty());
    H5O_info_t object;
    ASSERT_GE(H5Oget_info(group.id(), &object), 0);
    at = object.addr;
    bytes = file.bytes();
  }
  constexpr std::size_t kLinks = 4;  // where the header of version 1 counts the links to its object
  ASSERT_EQ(bytes[at], 1);
  ASSERT_EQ(bytes[at + kLinks], 2);
  bytes[at + kLinks] = 1;
  const File damaged = File::in_memory(bytes, "damaged.h5");
  try {
    (void)damaged.datasets();
    FAIL() << "the group was taken for many";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("damaged.h5: the group '/a/self' is in the file twice, or within"));
  }
}

}  // namespace
}  // namespace meshorder::hdf5
