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
  model.kernels.fill(
      {.access = 1, .miss = {10, 100, 1000, 1e4}, .jump = {1e5, 1e6, 1e7, 1e8}, .repeat = 1e9});
  return model;
}

/// `count` accesses each of distance 10, 100, 1000, 10,000 lines; the last of them a jump.
RunReuse some_reuse(int count) {
  RunReuse reuse;
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
  const double ms = predicted_ms(Kernel::element, some_reuse(2), lines({8, 64, 1600}), distinct_costs());
  EXPECT_DOUBLE_EQ(ms, 1e-6 * (8 + 8 * 10 + 6 * 100 + 4 * 1000 + 2 * 1e4 + 1e5 + 1e6 + 1e7 + 1e8));
}

TEST(CostModel, RepeatsCostWhateverTheCaches) {
  RunReuse reuse = some_reuse(2);
  const Caches caches = lines({8, 64, 1600});
  const double without = predicted_ms(Kernel::element, reuse, caches, distinct_costs());
  reuse.repeats = 3;
  EXPECT_DOUBLE_EQ(predicted_ms(Kernel::element, reuse, caches, distinct_costs()), without + 3e3);
}

TEST(CostModel, TakesTheLastOfTwoLevelsForTheSecondToo) {
  const double ms = predicted_ms(Kernel::spmv, some_reuse(2), lines({64, 1600}), distinct_costs());
  EXPECT_DOUBLE_EQ(ms, 1e-6 * (8 + 6 * 10 + 2 * 100 + 4 * 1000 + 2 * 1e4 + 1e5 + 1e6 + 1e7 + 1e8));
}

TEST(CostModel, LeavesOutWhatIsBetweenTheSecondLevelAndTheLast) {
  const double ms =
      predicted_ms(Kernel::spmv, some_reuse(2), lines({64, 512, 4096, 65536}), distinct_costs());
  EXPECT_DOUBLE_EQ(ms, 1e-6 * (8 + 6 * 10 + 4 * 100 + 1e5 + 1e6));
}

TEST(CostModel, NoCostIsNegativeAndLargerCachesNeverCostMore) {
  for (const Kernel kernel : kKernels) {
    const KernelCosts& costs = zen5_costs().kernels[static_cast<std::size_t>(kernel)];
    EXPECT_GT(costs.access, 0.0);
    for (int level = 0; level < 4; ++level) {
      EXPECT_GE(costs.miss[level], 0.0);
      EXPECT_GE(costs.jump[level], 0.0);
    }
    const double small = predicted_ms(kernel, some_reuse(5), lines({8, 16, 32}));
    const double large = predicted_ms(kernel, some_reuse(5), lines({512, 2048, 65536}));
    EXPECT_GT(small, large) << to_string(kernel);
    EXPECT_GT(large, 0.0);
  }
}

TEST(CostModel, RefusesNoCaches) {
  EXPECT_THROW((void)predicted_ms(Kernel::spmv, some_reuse(1), Caches{}), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
