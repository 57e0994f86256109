// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "rotation_time.hpp"

#include "base/random.hpp"
#include "base/stopwatch.hpp"
#include "kernels/aligned.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rotation_time.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/float_lanes-inl.hpp"
#include "kernels/rotation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// Adds up, in each lane, the entries of the rotations closest to `count` matrices; returns the largest
/// lane's sum. Entry k of matrix i is at [9 (i / 16) + k][i % 16].
template <class Lanes, class Number>
double rotate(const Number* matrices, Index count) {
  typename Lanes::Value sum = Lanes::set(0);
  for (Index batch = 0; batch < count / 16; ++batch) {
    for (Index lane = 0; lane < 16; lane += Lanes::kCount) {
      typename Lanes::Value f[3][3];
      typename Lanes::Value r[3][3];
      for (int k = 0; k < 9; ++k) f[k / 3][k % 3] = Lanes::load(matrices + 16 * (9 * batch + k) + lane);
      closest_rotations<Lanes>(f, r);
      for (const auto& row : r) sum = sum + row[0] + row[1] + row[2];
    }
  }
  alignas(64) Number lanes[16] = {};
  Lanes::store(sum, lanes);
  return static_cast<double>(*std::max_element(lanes, lanes + Lanes::kCount));
}

double rotate_doubles(const double* matrices, Index count) { return rotate<ManyLanes>(matrices, count); }
double rotate_floats(const float* matrices, Index count) { return rotate<ManyFloatLanes>(matrices, count); }

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(rotate_doubles);
MESHORDER_SIMD_VERSIONS(rotate_floats);

double rotate_chosen(const double* matrices, Index count) {
  return MESHORDER_SIMD(rotate_doubles)(matrices, count);
}
double rotate_chosen(const float* matrices, Index count) {
  return MESHORDER_SIMD(rotate_floats)(matrices, count);
}

constexpr Index kMatrices = 1024;  // they fit in the nearest cache
constexpr int kRounds = 2000;

template <class Number>
double best_ns(const AlignedVector<Number>& matrices) {
  double best = std::numeric_limits<double>::infinity();
  volatile double sink = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const Stopwatch stopwatch;
    sink = rotate_chosen(matrices.data(), kMatrices);
    best = std::min(best, 1e9 * stopwatch.seconds() / kMatrices);
  }
  static_cast<void>(sink);
  return best;
}

}  // namespace
}  // namespace meshorder

std::vector<RotationTime> rotation_times() {
  namespace mo = meshorder;
  mo::Random random(1);
  mo::AlignedVector<double> doubles(std::size_t{9} * mo::kMatrices);
  for (std::size_t i = 0; i < doubles.size(); ++i) {
    const std::size_t entry = i / 16 % 9;
    doubles[i] = (entry % 4 == 0 ? 1.0 : 0.0) + 0.5 * (2 * random.unit() - 1);
  }
  const mo::AlignedVector<float> floats(doubles.begin(), doubles.end());
  std::vector<RotationTime> times;
  for (std::int64_t targets = mo::simd_targets() & HWY_TARGETS; targets != 0; targets &= targets - 1) {
    mo::limit_simd_targets(targets);
    times.push_back({hwy::TargetName(targets & -targets), mo::best_ns(doubles), mo::best_ns(floats)});
  }
  mo::limit_simd_targets(0);
  return times;
}
#endif
