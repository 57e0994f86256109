// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "peak_flops.hpp"

#include "base/stopwatch.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "peak_flops.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// Computes rounds of multiply-adds, with enough independent ones to fill the pipeline; returns how many
/// operations these are.
double multiply_and_add(int rounds) {
  using Tag = hn::CappedTag<double, 8>;
  const Tag d;
  constexpr int kChains = 12;
  hn::Vec<Tag> sums[kChains];
  for (int i = 0; i < kChains; ++i) sums[i] = hn::Set(d, 1.0 + i);
  const auto factor = hn::Set(d, 0.999999);
  const auto term = hn::Set(d, 1e-6);
  for (int round = 0; round < rounds; ++round) {
#pragma GCC unroll 12
    for (auto& sum : sums) sum = hn::MulAdd(sum, factor, term);
  }
  auto total = sums[0];
  for (int i = 1; i < kChains; ++i) total = total + sums[i];
  // keeps the compiler from dropping the computation
  volatile double sink = hn::GetLane(hn::SumOfLanes(d, total));
  static_cast<void>(sink);
  return 2.0 * kChains * static_cast<double>(hn::MaxLanes(d)) * rounds;
}

}  // namespace
}  // namespace HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

MESHORDER_SIMD_VERSIONS(multiply_and_add);

double peak_gflops() {
  constexpr int kRounds = 2'000'000;
  double best = 0.0;
  for (int i = 0; i < 10; ++i) {
    const meshorder::Stopwatch stopwatch;
    const double operations = MESHORDER_SIMD(multiply_and_add)(kRounds);
    best = std::max(best, 1e-9 * operations / stopwatch.seconds());
  }
  return best;
}
#endif
