// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"
#include "metrics/reuse_distance.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_bench.hpp"

#include <array>
#include <string_view>

namespace meshorder {

/// Nanoseconds (≥ 0) that a kernel spends on each access, on each miss and, in addition, on each jump (a miss
/// that no hardware prefetcher foresees) of four caches: the first level, the second, half of the last and
/// all of it. A thread shares the last level, so misses begin to cost when half of it is full.
struct KernelCosts {
  double access = 0.0;
  std::array<double, 4> miss{};
  std::array<double, 4> jump{};
};

/// Costs of the kernels on a class of machines, with one thread.
struct CostModel {
  std::string_view machine;
  std::array<KernelCosts, kKernels.size()> kernels;
};

/// Returns costs that benchmarks/fit_cost_model fitted to measurements on a 2-core Zen 5 server processor (48
/// KB L1, 1 MB L2, 32 MB L3). docs/prediction.md shows how well they predict other meshes.
const CostModel& zen5_costs();

/// Predicts the milliseconds of each run of a repeated kernel on a processor with these caches. Use the ratio
/// of two orders of one mesh: the milliseconds are those of the model's machine. With one or two levels the
/// last one also counts as the second; with four or more only the first two and the last count. O(levels ·
/// bins of the histograms). Throws InvalidArgument without caches.
double predicted_ms(Kernel kernel, const Reuse& reuse, const Caches& caches,
                    const CostModel& model = zen5_costs());

/// As above, for all kernels.
KernelMilliseconds predicted_ms(const KernelReuse& reuse, const Caches& caches,
                                const CostModel& model = zen5_costs());

}  // namespace meshorder
