// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"
#include "metrics/reuse_distance.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_bench.hpp"

#include <array>
#include <string_view>

namespace meshorder {

/// Nanoseconds that a kernel spends on what happens in its stream of accesses, none negative: on each access,
/// each miss and, on top of it, each jump (a miss that no stream leads to) of four caches: the first level,
/// the second, half of the last and all of it. A thread has some part of the last level to itself, and its
/// misses begin to show when half of it is full.
struct KernelCosts {
  double access = 0.0;
  std::array<double, 4> miss{};
  std::array<double, 4> jump{};
};

/// What kernels cost on a class of machines, one thread.
struct CostModel {
  std::string_view machine;
  std::array<KernelCosts, kKernels.size()> kernels;
};

/// Fitted by benchmarks/fit_cost_model to what was measured on a 2-core Zen 5 server processor (48 KB L1, 1
/// MB L2, 32 MB L3). docs/prediction.md tells how well it predicts meshes that it was not fitted to.
const CostModel& zen5_costs();

/// The predicted milliseconds of one run of a kernel, when it is repeated, on a processor with these caches:
/// the ratio between two orders of one mesh is what it is good for, the milliseconds are those of the model's
/// machine. Of one or two levels the last
/// counts as the second too, of four or more those between do not count. O(levels · bins of the histograms).
/// Throws InvalidArgument without caches.
double predicted_ms(Kernel kernel, const Reuse& reuse, const Caches& caches,
                    const CostModel& model = zen5_costs());

/// Of all kernels, as kKernels lists them.
using KernelMilliseconds = std::array<double, kKernels.size()>;
KernelMilliseconds predicted_ms(const KernelReuse& reuse, const Caches& caches,
                                const CostModel& model = zen5_costs());

}  // namespace meshorder
