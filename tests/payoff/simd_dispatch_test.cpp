// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/simd_dispatch.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

int best(std::int64_t targets) { return static_cast<int>(simd_version(targets)); }

TEST(SimdDispatch, FindsTheInstructionSetsThatHighwaysLibraryFinds) {
  EXPECT_EQ(simd_targets() & HWY_TARGETS, (hwy::SupportedTargets() & HWY_TARGETS) | HWY_STATIC_TARGET);
}

TEST(SimdDispatch, TakesTheBestOfTheVersionsThatThereAre) {
  constexpr int kFallback = HWY_MAX_DYNAMIC_TARGETS;
  EXPECT_EQ(best(0), kFallback);
  EXPECT_LE(best(HWY_TARGETS), best(HWY_STATIC_TARGET));
#if HWY_ARCH_X86
  limit_simd_targets(HWY_SSE4 | HWY_AVX2);
  const int widest = best(HWY_TARGETS);
  limit_simd_targets(HWY_SSE4);
  const int narrowest = best(HWY_TARGETS);
  EXPECT_EQ(best(HWY_AVX2), kFallback);
  limit_simd_targets(0);
  if ((simd_targets() & HWY_AVX2) != 0) {
    EXPECT_EQ(widest, 9) << "AVX2 is the tenth of Highway's table";
    EXPECT_EQ(narrowest, 11);
  }
#endif
}

}  // namespace
}  // namespace meshorder
