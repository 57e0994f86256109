// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/machine.hpp"

#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace meshorder {
namespace {

TEST(Machine, CachesOfThePaperAreThoseOfItsProcessor) {
  EXPECT_EQ(to_string(parse_caches("paper")), "32K,256K,10M");
}

TEST(Machine, CachesOfThisMachineAreAscending) {
  const Caches caches = caches_of_this_machine();
  ASSERT_FALSE(caches.level_bytes.empty());
  EXPECT_GE(caches.level_bytes.front(), 4 << 10);
  EXPECT_LE(caches.level_bytes.back(), Offset{4} << 30);
  EXPECT_TRUE(std::is_sorted(caches.level_bytes.begin(), caches.level_bytes.end(), std::less_equal()));
  EXPECT_EQ(parse_caches("this"), caches);
  EXPECT_EQ(parse_caches(""), caches);
  EXPECT_EQ(parse_caches(to_string(caches)), caches);
}

TEST(Machine, CachesMayBeGivenBySizes) {
  EXPECT_EQ(parse_caches("48K,1M"), parse_cache_sizes("48K,1M"));
  EXPECT_THROW(parse_caches("paper,1G"), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
