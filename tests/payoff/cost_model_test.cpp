// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/cost_model.hpp"

#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Distinct weights for all counts, to detect mix-ups.
CostModel distinct_costs() {
  CostModel model;
  model.solid.fill({.access = 1, .miss = {10, 100, 1000, 1e4}, .jump = {1e5, 1e6, 1e7, 1e8}, .turn = 1e9});
  model.flat.fill({.access = 2});
  return model;
}

/// `count` accesses at each of the distances 10, 100, 1000 and 10,000 lines; the last of all is a jump.
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
  // 800 of 1600 lines count: accesses of distance 1000 miss
  const double ms = predicted_ms(some_reuse(2), lines({8, 64, 1600}), distinct_costs());
  EXPECT_DOUBLE_EQ(ms, 1e-6 * (8 + 8 * 10 + 6 * 100 + 4 * 1000 + 2 * 1e4 + 1e5 + 1e6 + 1e7 + 1e8));
}

TEST(CostModel, TurnsCostWhateverTheCaches) {
  RunReuse reuse = some_reuse(2);
  const Caches caches = lines({8, 64, 1600});
  const double without = predicted_ms(reuse, caches, distinct_costs());
  reuse.turns = 3;
  EXPECT_DOUBLE_EQ(predicted_ms(reuse, caches, distinct_costs()), without + 3e3);
}

TEST(CostModel, TrianglesHaveCostsOfTheirOwn) {
  RunReuse reuse = some_reuse(2);
  for (const int dimension : {2, 1}) {
    reuse.dimension = dimension;
    EXPECT_DOUBLE_EQ(predicted_ms(reuse, lines({8, 64, 1600}), distinct_costs()), 16e-6);
  }
}

TEST(CostModel, ARowOfCostsIsTheSameCosts) {
  const KernelCosts costs{1, {2, 3, 4, 5}, {6, 7, 8, 9}, 10};
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
  for (const CostModel* const model : {&zen3_costs()}) {
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
