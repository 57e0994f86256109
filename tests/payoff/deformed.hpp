// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/random.hpp"
#include "kernels/material.hpp"
#include "kernels/positions.hpp"
#include "kernels/simd_dispatch.hpp"
#include "kernels/simplices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace meshorder::test {

inline constexpr Lame kSteel{1.3, 0.7};

/// A patch of simplices that share vertices, at rest at irregular points, and deformed positions.
struct Patch {
  std::vector<Point> points;
  Simplices simplices;
  RestShapes rest;
  AlignedVector<double> positions;
};

/// `count` simplices of that dimension on count + dimension vertices. Neighbours share all vertices but one.
inline Patch deformed_patch(int dimension, Index count, std::uint64_t seed = 1) {
  Patch patch;
  Random random(seed);
  for (Index v = 0; v < count + dimension; ++v) {
    // a helix: neighbouring points are in general position
    patch.points.push_back({std::cos(2.0 * v) + 0.2 * random.unit(), std::sin(2.0 * v), 0.4 * v});
  }
  patch.simplices.dimension = dimension;
  for (Index s = 0; s < count; ++s) {
    for (int a = 0; a <= dimension; ++a) patch.simplices.vertices.push_back(s + (a + s) % (dimension + 1));
  }
  patch.rest = rest_shapes(patch.simplices, patch.points);
  patch.positions = padded_positions(patch.points);
  for (std::size_t i = 0; i < patch.positions.size(); ++i) {
    if (i % kPaddedStride != 3) patch.positions[i] += 0.3 * random.unit();
  }
  return patch;
}

inline double largest(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [](double sofar, double value) { return std::max(sofar, std::abs(value)); });
}

/// EXPECTs that no entry differs by more than `tolerance` times the largest one.
inline void expect_near(std::span<const double> actual, std::span<const double> expected, double tolerance) {
  ASSERT_EQ(actual.size(), expected.size());
  const double scale = largest(expected);
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_NEAR(actual[i], expected[i], tolerance * scale) << "entry " << i;
  }
}

/// EXPECTs the sums of forces and of their moments about the origin to be zero.
inline void expect_balanced(std::span<const double> forces, std::span<const double> positions) {
  double force[3] = {};
  double moment[3] = {};
  for (std::size_t v = 0; v < forces.size(); v += kPaddedStride) {
    const double* const f = forces.data() + v;
    const double* const x = positions.data() + v;
    for (int c = 0; c < 3; ++c) {
      force[c] += f[c];
      moment[c] += x[(c + 1) % 3] * f[(c + 2) % 3] - x[(c + 2) % 3] * f[(c + 1) % 3];
    }
    EXPECT_EQ(f[3], 0.0);
  }
  const double scale = largest(forces) * largest(positions);
  EXPECT_GT(scale, 0.0);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(force[c], 0.0, 1e-13 * scale);
    EXPECT_NEAR(moment[c], 0.0, 1e-13 * scale);
  }
}

/// Calls `check` with each instruction set that this processor has.
template <class Check>
void for_each_target(Check check) {
  for (std::int64_t targets = simd_targets(); targets != 0; targets &= targets - 1) {
    // without the best targets, which were tried before; the last one left is the baseline
    limit_simd_targets(targets);
    check(hwy::TargetName(targets & -targets));
  }
  limit_simd_targets(0);
}

}  // namespace meshorder::test
