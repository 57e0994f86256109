// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/quantities.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

TEST(Quantities, DurationsTakeTheNextUnitWhereTheyRoundToIt) {
  EXPECT_EQ(duration(0.0123), "12.3 ms");
  EXPECT_EQ(duration(0.9994), "999 ms");
  EXPECT_EQ(duration(0.9996), "1.0 s");
  EXPECT_EQ(duration(59.94), "59.9 s");
  EXPECT_EQ(duration(59.96), "1 min 0 s");
  EXPECT_EQ(duration(61), "1 min 1 s");
}

}  // namespace
}  // namespace meshorder
