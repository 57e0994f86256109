// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/bandwidth.hpp"

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "kernels/aligned.hpp"

#include <algorithm>
#include <cstdint>

namespace meshorder {

double read_bandwidth(std::size_t buffer_bytes, int passes, int threads) {
  // integers, since the compiler may sum them in vectors
  const AlignedVector<std::uint64_t> buffer(std::max<std::size_t>(1, buffer_bytes / sizeof(std::uint64_t)),
                                            1);
  const auto parts = static_cast<std::size_t>(std::max(1, threads));
  double best = 0.0;
  for (int pass = 0; pass < passes; ++pass) {
    const Stopwatch stopwatch;
    for_each_part(static_cast<Index>(parts), [&](Index part) {
      const std::size_t end = buffer.size() * (static_cast<std::size_t>(part) + 1) / parts;
      std::uint64_t sum = 0;
      for (std::size_t i = buffer.size() * static_cast<std::size_t>(part) / parts; i < end; ++i) {
        sum += buffer[i];
      }
      // forces the compiler to compute the sum before the clock is read
      asm volatile("" : "+r"(sum) : : "memory");
    });
    const double seconds = std::max(stopwatch.seconds(), 1e-9);
    best = std::max(best, static_cast<double>(buffer.size() * sizeof(std::uint64_t)) / seconds);
  }
  return 1e-9 * best;
}

}  // namespace meshorder
