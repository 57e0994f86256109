// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

namespace meshorder {

/// Seeded random numbers that are the same with every compiler and standard library (the distributions of
/// <random> are not).
class Random {
  using Engine = std::mt19937_64;

 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Returns a number that is uniform in 0 … bound−1, bound > 0.
  std::uint64_t below(std::uint64_t bound) {
    const std::uint64_t unbiased = Engine::max() - Engine::max() % bound;
    std::uint64_t value = engine_();
    while (value >= unbiased) value = engine_();
    return value % bound;
  }

  /// Returns a number that is uniform in [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  Engine engine_;
};

}  // namespace meshorder
