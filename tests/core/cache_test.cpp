// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/cache.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace meshorder {
namespace {

TEST(Caches, AreParsedFromTheirSizes) {
  EXPECT_EQ(parse_caches("48K,1M,32M").level_bytes, (std::vector<Offset>{49152, 1 << 20, 32 << 20}));
  EXPECT_EQ(parse_caches("64,128k,2g").level_bytes, (std::vector<Offset>{64, 128 << 10, Offset{2} << 30}));
  EXPECT_EQ(parse_caches("512").level_bytes, (std::vector<Offset>{512}));
}

TEST(Caches, AreWrittenAsTheyAreRead) {
  for (const std::string text : {"48K,1M,32M", "64,1280K,3G", "32K,256K,10M"}) {
    EXPECT_EQ(to_string(parse_caches(text)), text);
  }
  EXPECT_EQ(to_string(parse_caches("1024,1024K")), "1K,1M");
}

TEST(Caches, OfThePaperAreThoseOfItsProcessor) {
  EXPECT_EQ(to_string(parse_caches("paper")), "32K,256K,10M");
}

TEST(Caches, OfThisMachineRise) {
  const Caches caches = caches_of_this_machine();
  ASSERT_FALSE(caches.level_bytes.empty());
  EXPECT_GE(caches.level_bytes.front(), 4 << 10);
  EXPECT_LE(caches.level_bytes.back(), Offset{4} << 30);
  EXPECT_TRUE(std::is_sorted(caches.level_bytes.begin(), caches.level_bytes.end(), std::less_equal()));
  EXPECT_EQ(parse_caches("this"), caches);
  EXPECT_EQ(parse_caches(""), caches);
  EXPECT_EQ(parse_caches(to_string(caches)), caches);
}

TEST(Caches, MustBeRisingSizesOfWholeLines) {
  for (const char* const text :
       {"large", "48", "0", "-64K", "48K,", ",48K", "48K,,1M", "48 K", "4.5M", "48KB", "K", "1M,48K", "1M,1M",
        "48K;1M", "99999999999999999999", "9999999999999G", "paper,1G"}) {
    EXPECT_THROW(parse_caches(text), InvalidArgument) << text;
  }
}

TEST(Caches, MissWhatIsReusedTooLate) {
  ReuseHistogram histogram;
  histogram.add_cold();
  for (const Index distance : {0, 1, 2, 3, 4, 100}) histogram.add(distance);
  EXPECT_EQ(misses(histogram, parse_caches("64,128,256,1M")), (std::vector<Offset>{6, 5, 3, 1}));
}

}  // namespace
}  // namespace meshorder
