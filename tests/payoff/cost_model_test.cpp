// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/cost_model.hpp"

#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Counts with a weight of their own each, so that any mix-up shows.
CostModel distinct_costs() {
  CostModel model;
  model.solid.fill({.access = 1,
                    .miss = {10, 100, 1000, 1e4},
                    .jump = {1e5, 1e6, 1e7, 1e8},
                    .repeat = 1e9,
                    .wait = {1e10, 1e11, 1e12},
                    .stall = 1e13});
  model.flat.fill({.access = 2});
  return model;
}

/// `count` accesses each of distance 10, 100, 1000, 10,000 lines; the last of them a jump.
RunReuse some_reuse(int count) {
  RunReuse reuse;
  reuse.dimension = 3;
  for (const Index distance : {10, 100, 1000, 10'000}) {
    for (int i = 0; i < count; ++i) reuse.all.add(distance);
  }
  reuse.jumps.add(10'000);
  return reuse;
}

Caches lines(std::vector<Offset> of_levels) {
  for (Offset& level : of_levels) level *= kLineBytes;
  return {std::move(of_levels)};
}

TEST(CostModel, AddsUpAccessesMissesAndJumps) {
  // 800 of 1600 lines lets the accesses of distance 1000 miss
  const double ms = predicted_ms(some_reuse(2), lines({8, 64, 1600}), distinct_costs());
  EXPECT_DOUBLE_EQ(ms, 1e-6 * (8 + 8 * 10 + 6 * 100 + 4 * 1000 + 2 * 1e4 + 1e5 + 1e6 + 1e7 + 1e8));
}

TEST(CostModel, RepeatsCostWhateverTheCaches) {
  RunReuse reuse = some_reuse(2);
  const Caches caches = lines({8, 64, 1600});
  const double without = predicted_ms(reuse, caches, distinct_costs());
  reuse.repeats = 3;
  EXPECT_DOUBLE_EQ(predicted_ms(reuse, caches, distinct_costs()), without + 3e3);
}

TEST(CostModel, JumpsOfAProductInTheLastCacheThatAreCloseTogetherWaitTogether) {
  const Caches caches = lines({8, 64, 1600});
  RunReuse reuse = some_reuse(2);
  const double without = predicted_ms(reuse, caches, distinct_costs());
  const auto waits = [&](Offset gathers, int jumps) {
    reuse.gathers = gathers;
    reuse.jumps = {};
    for (int i = 0; i < jumps; ++i) reuse.jumps.add(10'000);
    const double with = predicted_ms(reuse, caches, distinct_costs());
    return 1e-6 * (with - without - (jumps - 1) * 1e-6 * (1e5 + 1e6 + 1e7 + 1e8));
  };
  // one by one, each waits by itself
  EXPECT_NEAR(waits(1'000'000, 10), 10, 0.01);
  // half of all: each 32 wait once
  EXPECT_NEAR(waits(6400, 3200), 200, 0.01);
  // an estimated number may be above the whole
  EXPECT_NEAR(waits(3200, 3300), 100, 0.01);
}

TEST(CostModel, StallsCostInTheShareOfTheStreamsThatMissesTheLastCache) {
  RunReuse reuse = some_reuse(2);
  const auto stalls = [&](Offset gathers, Offset last_cache, Offset count) {
    const Caches caches = lines({8, 64, last_cache});
    reuse.gathers = gathers;
    reuse.stalls = 0;
    const double without = predicted_ms(reuse, caches, distinct_costs());
    reuse.stalls = count;
    return 1e6 * (predicted_ms(reuse, caches, distinct_costs()) - without);
  };
  // of 8 accesses 2 miss 1,600 lines, 4 miss 200; the jump of the first two caches is free in the same share
  const double jump = 1e5 + 1e6;
  EXPECT_NEAR(stalls(0, 1600, 4), 1e13 - jump / 4, 1);
  EXPECT_NEAR(stalls(5, 1600, 3), 2e13 - jump * 2 / 3, 1);
  EXPECT_NEAR(stalls(5, 200, 3), 3e13 - jump, 1);  // gathered accesses miss, too
  EXPECT_NEAR(stalls(5, 1 << 20, 3), 0, 1);
  EXPECT_NEAR(stalls(8, 1600, 3), 0, 1);
}

TEST(CostModel, FirstJumpsOfOtherKernelsAreWaitsAndJumpsOfTheFirstCacheStalls) {
  const Caches caches = lines({8, 64, 1600});
  for (const Kernel kernel : {Kernel::element, Kernel::assembly, Kernel::springs}) {
    RunReuse reuse = some_reuse(2000);
    reuse.kernel = kernel;
    reuse.gathers = 6400;
    reuse.jumps = {};
    const double without = predicted_ms(reuse, caches, distinct_costs());
    for (int i = 0; i < 3200; ++i) reuse.jumps.add(10'000);
    // half of all gathered accesses: of each 32 the first jump waits; all streams come from memory
    const double waits = 200;
    const double expected =
        waits * (1e10 + 1e11 + 1e12) + 3200 * (1e5 + 1e13) + (3200 - waits) * (1e6 + 1e7 + 1e8);
    EXPECT_NEAR(1e6 * (predicted_ms(reuse, caches, distinct_costs()) - without) / expected, 1, 1e-9);
    // where nothing comes from memory nothing stalls
    const double in_cache = predicted_ms(reuse, lines({8, 64, 1 << 20}), distinct_costs());
    reuse.jumps = {};
    EXPECT_NEAR(1e6 * (in_cache - predicted_ms(reuse, lines({8, 64, 1 << 20}), distinct_costs())) /
                    (waits * 1e10 + 3200 * 1e5 + (3200 - waits) * 1e6),
                1, 1e-9);
    // one by one, each waits by itself
    reuse.gathers = 7'000;
    reuse.jumps.add(10'000);
    CostModel model = distinct_costs();
    model.stalls = false;
    const double as_jump = predicted_ms(reuse, caches, model);
    EXPECT_NEAR(1e6 * (predicted_ms(reuse, caches, distinct_costs()) - as_jump),
                1e13 + 1e10 + 1e11 - 1e6 - 1e7 - 1e8, 3e8);
  }
}

TEST(CostModel, CostsFittedWithoutStallsGoByAllJumps) {
  CostModel model = distinct_costs();
  RunReuse reuse = some_reuse(2);
  const Caches caches = lines({8, 64, 1600});
  const double without = predicted_ms(reuse, caches, model);
  reuse.stalls = 3;
  EXPECT_NE(predicted_ms(reuse, caches, model), without);
  model.stalls = false;
  EXPECT_EQ(predicted_ms(reuse, caches, model), without);
  EXPECT_TRUE(zen4_costs().stalls);
  EXPECT_FALSE(zen5_costs().stalls);
}

TEST(CostModel, TrianglesHaveCostsOfTheirOwn) {
  RunReuse reuse = some_reuse(2);
  for (const int dimension : {2, 1}) {
    reuse.dimension = dimension;
    EXPECT_DOUBLE_EQ(predicted_ms(reuse, lines({8, 64, 1600}), distinct_costs()), 16e-6);
  }
}

TEST(CostModel, ARowOfCostsIsTheSameCosts) {
  const KernelCosts costs{1, {2, 3, 4, 5}, {6, 7, 8, 9}, 10, {11, 12, 13}, 14};
  const CostRow row = as_row(costs);
  for (std::size_t i = 0; i < row.size(); ++i) EXPECT_EQ(row[i], static_cast<double>(i + 1));
  EXPECT_EQ(as_costs(row), costs);
}

TEST(CostModel, TakesTheLastOfTwoLevelsForTheSecondToo) {
  const double ms = predicted_ms(some_reuse(2), lines({64, 1600}), distinct_costs());
  EXPECT_DOUBLE_EQ(ms, 1e-6 * (8 + 6 * 10 + 2 * 100 + 4 * 1000 + 2 * 1e4 + 1e5 + 1e6 + 1e7 + 1e8));
}

TEST(CostModel, LeavesOutWhatIsBetweenTheSecondLevelAndTheLast) {
  const double ms = predicted_ms(some_reuse(2), lines({64, 512, 4096, 65536}), distinct_costs());
  EXPECT_DOUBLE_EQ(ms, 1e-6 * (8 + 6 * 10 + 4 * 100 + 1e5 + 1e6));
}

TEST(CostModel, NoCostIsNegativeAndLargerCachesNeverCostMore) {
  for (const CostModel* const model : {&zen5_costs(), &zen4_costs(), &zen3_costs(), &xeon_costs()}) {
    for (const Kernel kernel : kKernels) {
      for (const int dimension : {2, 3}) {
        const KernelCosts& costs = model->costs(kernel, dimension);
        EXPECT_GT(costs.access, 0.0);
        for (const double cost : as_row(costs)) EXPECT_GE(cost, 0.0);
        RunReuse reuse = some_reuse(5);
        reuse.kernel = kernel;
        reuse.dimension = dimension;
        const double small = predicted_ms(reuse, lines({8, 16, 32}), *model);
        const double large = predicted_ms(reuse, lines({512, 2048, 65536}), *model);
        EXPECT_GT(small, large) << to_string(kernel);
        EXPECT_GT(large, 0.0);
      }
    }
  }
}

TEST(CostModel, RefusesNoCaches) {
  EXPECT_THROW((void)predicted_ms(some_reuse(1), Caches{}), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
