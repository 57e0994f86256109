// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/memory_probe.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

TEST(ReadBandwidth, IsThatOfAMachine) {
  const double gigabytes_per_second = read_bandwidth(std::size_t{32} << 20, 3);
  EXPECT_GT(gigabytes_per_second, 0.05);
  EXPECT_LT(gigabytes_per_second, 5000.0);
}

TEST(ReadBandwidth, TakesAnyBufferAndNumberOfThreads) {
  EXPECT_GT(read_bandwidth(0, 1), 0.0);
  EXPECT_GT(read_bandwidth(8, 1, 3), 0.0);
  EXPECT_GT(read_bandwidth(1000, 1, 0), 0.0);
}

}  // namespace
}  // namespace meshorder
