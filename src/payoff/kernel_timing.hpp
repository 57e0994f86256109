// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "payoff/kernel_bench.hpp"

#include <functional>
#include <span>
#include <vector>

namespace meshorder {

/// How long and how often kernels are run.
struct TimingOptions {
  /// No round begins that is not expected to end within this time; preparation and warm-up come on top.
  double budget_seconds = 12.0;
  int least_rounds = 3;  ///< whatever they cost
  int most_rounds = 25;
  /// A kernel that takes less is repeated until one sample takes as long: solvers repeat it too, and find in
  /// the caches what the last run left there.
  double sample_seconds = 0.02;
  /// For time_orders: what all prepared orders may hold together; 0 for half of the machine's memory.
  std::size_t memory_bytes = 0;
};

/// Times of one kernel in one order.
struct KernelTimes {
  double best_ms = 0.0;
  double median_ms = 0.0;
  double speedup = 1.0;  ///< best_ms of the reference order in the same rounds, divided by this best_ms
  int samples = 0;
};

/// By kernel: `times[static_cast<std::size_t>(Kernel::spmv)]`.
struct OrderTimes {
  std::array<KernelTimes, kKernels.size()> times;

  [[nodiscard]] const KernelTimes& operator[](Kernel kernel) const {
    return times[static_cast<std::size_t>(kernel)];
  }
  [[nodiscard]] KernelTimes& operator[](Kernel kernel) { return times[static_cast<std::size_t>(kernel)]; }
};

/// Times every kernel of the prepared orders in interleaved rounds, so that a machine that changes its pace
/// changes it for all of them: a round takes one sample of every kernel in every order, each kernel's samples
/// in a row, and the next round starts with the next order. A sample's first run finds the caches as another
/// order left them and does not count, unless the kernel takes 0.1 s, so that caches hardly matter. The first
/// bench is the reference of the speedups. One thread.
std::vector<OrderTimes> time_interleaved(std::span<KernelBench* const> benches,
                                         const TimingOptions& options = {});

/// The same for `orders` orders, prepared when they are needed: `prepare(i)` gives the bench of order i, and
/// order 0 is the reference. When all of them would not fit in the memory allowed, they are timed in groups,
/// each together with the reference, and share the budget; two benches must fit at least.
std::vector<OrderTimes> time_orders(Index orders, const std::function<KernelBench(Index)>& prepare,
                                    const TimingOptions& options = {});

}  // namespace meshorder
