// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "payoff/kernel_bench.hpp"
#include "payoff/steadiness.hpp"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace meshorder {

/// Largest bytes of a bench that is copied for each sample. The memory of larger ones exceeds the caches, and
/// is spread over so many pages that their places hardly matter.
inline constexpr std::size_t kMostCopied = std::size_t{256} << 20;

/// Options for timing kernels.
struct TimingOptions {
  /// A round begins only if it should end within this time. The time includes the first runs, which plan the
  /// samples, but not the preparation of the orders.
  double budget_seconds = 12.0;
  int min_rounds = 3;  ///< these rounds run even if they exceed the budget
  /// Time a kernel by stretches of the elements in orders in which it is plainly slow, see
  /// `KernelTimes::share`.
  bool in_stretches = false;
  int max_rounds = 25;
  /// Least seconds of a sample. A kernel that takes less is repeated, as in a solver, and finds the data of
  /// its previous run in the caches.
  double sample_seconds = 0.02;
  /// Count the calling thread's processor time instead of elapsed time: for kernels on one thread.
  bool processor_time = false;
  /// For time_orders: memory for all prepared orders together; 0: half of the machine's memory.
  std::size_t memory_bytes = 0;
};

/// Times of a kernel in an order.
struct KernelTimes {
  double best_ms = 0.0;
  double median_ms = 0.0;
  /// Time of the reference / this time, from the pairs of each round, widened by the noise. Of a single
  /// sample, the interval is a quarter to both sides.
  TimeRatio gain = {1, 1, 1};
  int samples = 0;
  double share = 1;  ///< share of the elements that ran; if below 1, the times are the measured ones / share
};

/// Times of all kernels in an order.
struct OrderTimes {
  std::array<KernelTimes, kKernels.size()> times;

  [[nodiscard]] const KernelTimes& operator[](Kernel kernel) const {
    return times[static_cast<std::size_t>(kernel)];
  }
  [[nodiscard]] KernelTimes& operator[](Kernel kernel) { return times[static_cast<std::size_t>(kernel)]; }
};

/// The times of several orders, and how far they can be trusted.
struct Timings {
  std::vector<OrderTimes> orders;
  OrderTimes again;  ///< the first order, timed once more: what its times differ by is the noise
  Steadiness steadiness;
};

/// Returns the kernels of order i, prepared.
using PrepareOrder = std::function<std::unique_ptr<KernelBench>(Index)>;

/// Times every kernel of the prepared orders, which must all run the same kernels, in interleaved rounds, so
/// that changes of the machine's speed affect all orders alike. A round takes a sample of every kernel in
/// every order, and in the first one twice; the next round begins with the next order. All orders run in the
/// same memory, since the place of an array alone can change a time by a half; benches of more than
/// `kMostCopied` bytes run in their own. The first runs of a sample find another order's data in the caches
/// and are not counted; their number is `runs_to_settle`. If a run takes at least five times
/// `sample_seconds`, all runs count, and the last run of the plan is the sample of the first round. If a
/// kernel takes 0.1 s or more in an order, and three times as long as in the fastest order, the run that
/// planned its samples is its only sample there. With `in_stretches` this run is one by
/// `KernelBench::run_stretches`, if that takes 0.05 s or more. The first bench is the reference of the
/// speedups.
Timings time_interleaved(std::span<KernelBench* const> benches, const TimingOptions& options = {});

/// Does the same for orders that are prepared when needed: `prepare(i)` returns the bench of order i; order 0
/// is the reference. If not all benches fit into the allowed memory, orders are timed in groups, each
/// together with the reference, and the groups share the budget. Two benches are always held at once, even if
/// they exceed that memory.
Timings time_orders(Index orders, const PrepareOrder& prepare, const TimingOptions& options = {});

/// A function that times orders as `time_orders` does.
using OrderTimer =
    std::function<Timings(Index orders, const PrepareOrder& prepare, const TimingOptions& options)>;

}  // namespace meshorder
