// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/cache.hpp"

#include <meshorder/error.hpp>

#include <gtest/gtest.h>

namespace meshorder {
namespace {

TEST(Caches, AreParsedFromTheirSizes) {
  EXPECT_EQ(parse_cache_sizes("48K,1M,32M").level_bytes, (std::vector<Offset>{49152, 1 << 20, 32 << 20}));
  EXPECT_EQ(parse_cache_sizes("64,128k,2g").level_bytes,
            (std::vector<Offset>{64, 128 << 10, Offset{2} << 30}));
  EXPECT_EQ(parse_cache_sizes("512").level_bytes, (std::vector<Offset>{512}));
}

TEST(Caches, AreWrittenAsTheyAreRead) {
  for (const std::string text : {"48K,1M,32M", "64,1280K,3G", "32K,256K,10M"}) {
    EXPECT_EQ(to_string(parse_cache_sizes(text)), text);
  }
  EXPECT_EQ(to_string(parse_cache_sizes("1024,1024K")), "1K,1M");
}

TEST(Caches, MustBeAscendingSizesOfWholeLines) {
  for (const char* const text :
       {"large", "48", "0", "-64K", "48K,", ",48K", "48K,,1M", "48 K", "4.5M", "48KB", "K", "1M,48K", "1M,1M",
        "48K;1M", "99999999999999999999", "9999999999999G", "paper,1G", "this", ""}) {
    EXPECT_THROW(parse_cache_sizes(text), InvalidArgument) << text;
  }
}

TEST(Caches, MissWhatIsReusedTooLate) {
  ReuseHistogram histogram;
  histogram.add_cold();
  for (const Index distance : {0, 1, 2, 3, 4, 100}) histogram.add(distance);
  EXPECT_EQ(misses(histogram, parse_cache_sizes("64,128,256,1M")), (std::vector<Offset>{6, 5, 3, 1}));
}

}  // namespace
}  // namespace meshorder
