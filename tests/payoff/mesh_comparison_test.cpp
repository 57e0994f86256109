// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/mesh_comparison.hpp"

#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

TEST(PartsInWords, ListsTheTimesThatFollowFromAPartOfTheElements) {
  MeshComparison comparison =
      compare_orders(test::tetrahedral_bar(5), {.methods = {{"hilbert", "lexmax"}}, .budget_seconds = 0.01});
  EXPECT_EQ(parts_in_words(comparison), "");
  OrderTimes& own = comparison.kernels.front().orders[0];
  own[Kernel::element].share = own[Kernel::assembly].share = 1.0 / 8;
  comparison.kernels.front().orders[1][Kernel::assembly].share = 1.0 / 8;
  EXPECT_EQ(parts_in_words(comparison),
            "slow, so computed from the time of 1/8 of the elements: element force in original; assembly in "
            "original, hilbert");
}

}  // namespace
}  // namespace meshorder
