// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/random.hpp"
#include "payoff/memory_probe.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace meshorder {
namespace {

constexpr Offset kLargest = Offset{256} << 20;

/// A cache, and the extra cost of a miss compared with a hit.
struct Level {
  Offset bytes;
  double cost;
};

/// Latencies of random loads, from the hit rates of caches that keep random lines.
std::vector<ProbePoint> latencies(double first, const std::vector<Level>& levels, double noise = 0) {
  Random random(1);
  std::vector<ProbePoint> points;
  for (const Offset bytes : probe_sizes(kLargest)) {
    double latency = first;
    for (const Level& level : levels) {
      const double kept = std::min(1.0, static_cast<double>(level.bytes) / static_cast<double>(bytes));
      latency += (1 - kept) * level.cost;
    }
    points.push_back({bytes, latency * (1 + noise * random.unit())});
  }
  return points;
}

void expect_near(Offset found, Offset expected) {
  EXPECT_GT(found, expected * 3 / 4);
  EXPECT_LT(found, expected * 4 / 3);
}

TEST(CacheProbe, SizesRiseByThirdsOfDoublings) {
  const std::vector<Offset> sizes = probe_sizes(kLargest);
  EXPECT_EQ(sizes.front(), 8 << 10);
  EXPECT_EQ(sizes.back(), kLargest);
  EXPECT_EQ(sizes.size(), 3 * 15 + 1U);
  EXPECT_TRUE(std::is_sorted(sizes.begin(), sizes.end()));
  for (const Offset size : sizes) EXPECT_EQ(size % 64, 0);
}

TEST(CacheProbe, FindsThreeCachesInTheirLatencies) {
  for (const double noise : {0.0, 0.05}) {
    const FoundCaches found =
        find_caches(latencies(1, {{48 << 10, 3}, {1 << 20, 12}, {32 << 20, 90}}, noise));
    ASSERT_EQ(found.levels.size(), 3U) << noise;
    expect_near(found.levels[0].bytes, 48 << 10);
    expect_near(found.levels[1].bytes, 1 << 20);
    expect_near(found.levels[2].bytes, 32 << 20);
    EXPECT_NEAR(found.levels[0].nanoseconds, 1, 0.1);
    EXPECT_NEAR(found.levels[1].nanoseconds, 4, 0.5);
    EXPECT_NEAR(found.levels[2].nanoseconds, 16, 2);
    EXPECT_NEAR(found.memory_nanoseconds, 106, 8);
  }
}

TEST(CacheProbe, FindsTwoCachesWhereThereAreTwo) {
  const FoundCaches found = find_caches(latencies(1.5, {{64 << 10, 8}, {2 << 20, 100}}, 0.02));
  ASSERT_EQ(found.levels.size(), 2U);
  expect_near(found.levels[0].bytes, 64 << 10);
  expect_near(found.levels[1].bytes, 2 << 20);
}

TEST(CacheProbe, TablesOfPagesAreNoCaches) {
  const FoundCaches found = find_caches(
      latencies(1, {{32 << 10, 3}, {1 << 20, 10}, {24 << 20, 90}, {Offset{150} << 20, 15}}, 0.02));
  ASSERT_EQ(found.levels.size(), 3U);
  expect_near(found.levels[2].bytes, 24 << 20);
}

TEST(CacheProbe, FindsOneWhereNothingRises) {
  const FoundCaches found = find_caches(latencies(2, {}, 0.05));
  ASSERT_EQ(found.levels.size(), 1U);
  EXPECT_EQ(found.levels[0].bytes, kLargest);
  EXPECT_THROW((void)find_caches({}), InvalidArgument);
}

TEST(CacheProbe, LoadsTakeLongerInMoreMemory) {
  const std::vector<Offset> sizes{Offset{8} << 10, Offset{64} << 20};
  double told = -1;
  const std::vector<ProbePoint> points = probe_latencies(sizes, 3, [&](double share) {
    EXPECT_GE(share, told);
    EXPECT_LT(share, 1);
    told = share;
  });
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[1].bytes, sizes[1]);
  EXPECT_GE(points[0].nanoseconds, 0.1);
  EXPECT_GT(points[1].nanoseconds, 2 * points[0].nanoseconds);
  EXPECT_GT(told, 0.7);
}

}  // namespace
}  // namespace meshorder
