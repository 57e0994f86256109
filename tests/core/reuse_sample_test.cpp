// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/reuse_sample.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kLines = 40'000;

/// Random accesses to a window of lines that wanders, with streams of two and nine lines between.
std::vector<Index> wandering_stream() {
  Random random(7);
  std::vector<Index> stream;
  for (Index i = 0; i < 400'000; ++i) {
    const Index window = i / 20 % (kLines / 2);
    stream.push_back(window + static_cast<Index>(random.below(3000)));
    stream.push_back(kLines / 2 + i / 4 % (kLines / 2));
  }
  return stream;
}

Reuse sampled(const std::vector<Index>& stream, int halvings) {
  ReuseSample sample(kLines, halvings);
  for (const Index line : stream) sample.access(line);
  return std::move(sample).repeated();
}

TEST(ReuseSample, OfAllLinesIsTheMeasurement) {
  const std::vector<Index> stream = wandering_stream();
  ReuseDistance distance(kLines);
  for (const Index line : stream) distance.access(line);
  EXPECT_EQ(sampled(stream, 0), std::move(distance).repeated());
}

TEST(ReuseSample, EstimatesMissesAndJumps) {
  const std::vector<Index> stream = wandering_stream();
  const Reuse exact = sampled(stream, 0);
  for (const int halvings : {1, 3}) {
    const Reuse estimate = sampled(stream, halvings);
    const auto all = static_cast<double>(exact.all.accesses());
    EXPECT_NEAR(static_cast<double>(estimate.all.accesses()) / all, 1, 0.04);
    for (const Offset lines : {768, 2048, 16'384, 30'000}) {
      EXPECT_NEAR(static_cast<double>(estimate.all.misses(lines)) / all,
                  static_cast<double>(exact.all.misses(lines)) / all, 0.03)
          << halvings << " halvings, " << lines << " lines";
      EXPECT_NEAR(static_cast<double>(estimate.jumps.misses(lines)) / all,
                  static_cast<double>(exact.jumps.misses(lines)) / all, 0.03)
          << halvings << " halvings, " << lines << " lines";
    }
  }
  EXPECT_GT(exact.jumps.misses(768), exact.all.accesses() / 10);
}

TEST(ReuseSample, SaysWhetherOneOfSomeLinesIsSampled) {
  const auto is_sampled = [](Index line) { return sampled({line}, 3).all.accesses() > 0; };
  const ReuseSample sample(kLines, 3);
  Index first = 0;
  int with = 0;
  for (; first < 2000; first += 40) {
    bool some = false;
    for (Index line = first; line < first + 40; ++line) some = some || is_sampled(line);
    // the first two lines of a block are sampled, but not counted
    const bool told = sample.samples(first, first + 39);
    EXPECT_TRUE(told || !some) << first;
    with += told ? 1 : 0;
  }
  EXPECT_GT(with, 5);
  EXPECT_LT(with, 45);
  EXPECT_TRUE(ReuseSample(kLines, 0).samples(3, 3));
}

/// Consecutive lines that are gathered, each after `streamed` lines of a stream.
Reuse gathered_between_streams(int halvings, Index streamed) {
  constexpr Index kGathered = 20'000;
  ReuseSample sample(kGathered * (1 + streamed), halvings);
  Index stream = kGathered;
  for (Index line = 0; line < kGathered; ++line) {
    for (Index i = 0; i < streamed; ++i) sample.access(stream++, Access::streamed);
    sample.access(line, Access::gathered);
  }
  return std::move(sample).repeated();
}

TEST(ReuseSample, CountsWhatStreamsBetweenTwoLinesThatFollowEachOther) {
  // a gathered line leads to the next one if fewer than 64 accesses are between; else the next one is a jump
  for (const Index streamed : {45, 55, 75}) {
    const Reuse exact = gathered_between_streams(0, streamed);
    const Reuse estimate = gathered_between_streams(3, streamed);
    EXPECT_NEAR(static_cast<double>(estimate.jumps.accesses()), static_cast<double>(exact.jumps.accesses()),
                0.1 * 20'000)
        << streamed;
  }
  EXPECT_LT(gathered_between_streams(3, 55).jumps.accesses(), 100);
  EXPECT_GT(gathered_between_streams(0, 75).jumps.accesses(), 19'000);
}

TEST(ReuseSample, MeasuresEverySampledAccessHoweverFewThereAre) {
  constexpr int kHalvings = 2;
  const auto accesses = [](Index line, Index count) {
    return sampled(std::vector<Index>(static_cast<std::size_t>(count), line), kHalvings).all.accesses();
  };
  Index line = 0;
  while (line < 100 && accesses(line, 1) == 0) ++line;
  ASSERT_LT(line, 100);
  for (Index count = 0; count < 100; ++count) {
    EXPECT_EQ(accesses(line, count), std::llround(4 * 11.0 / 9 * count)) << count << " accesses";
  }
}

TEST(ReuseSample, AStreamHasNoJumps) {
  std::vector<Index> stream(kLines);
  std::iota(stream.begin(), stream.end(), Index{0});
  const Reuse estimate = sampled(stream, 3);
  EXPECT_NEAR(static_cast<double>(estimate.all.misses(768)), kLines, 0.05 * kLines);
  EXPECT_EQ(estimate.jumps.misses(768), 0);
}

}  // namespace
}  // namespace meshorder
