// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/stopwatch.hpp>
#include <meshorder/sim/kernels/aligned.hpp>
#include <meshorder/study/bandwidth.hpp>

#include <algorithm>
#include <cstdint>

namespace meshorder {

double read_bandwidth(std::size_t buffer_bytes, int passes) {
  // integers, since the compiler may sum them in vectors
  const AlignedVector<std::uint64_t> buffer(std::max<std::size_t>(1, buffer_bytes / sizeof(std::uint64_t)),
                                            1);
  std::uint64_t sum = 0;
  double best = 0.0;
  for (int pass = 0; pass < passes; ++pass) {
    const Stopwatch stopwatch;
    for (const std::uint64_t value : buffer) sum += value;
    // the sum is wanted, and wanted now: the clock must not be read before
    asm volatile("" : "+r"(sum) : : "memory");
    const double seconds = std::max(stopwatch.seconds(), 1e-9);
    best = std::max(best, static_cast<double>(buffer.size() * sizeof(std::uint64_t)) / seconds);
  }
  return 1e-9 * best;
}

}  // namespace meshorder
