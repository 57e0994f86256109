// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"
#include "metrics/reuse_distance.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_bench.hpp"

#include <array>
#include <string>

namespace meshorder {

/// Nanoseconds (≥ 0) that a kernel spends on each access, on each miss and, in addition, on each jump (a miss
/// that no hardware prefetcher foresees) of four caches: the first level, the second, half of the last and
/// all of it; on each repeat (RunReuse::repeats); on each wait, by cache from the second on: jumps that are
/// among the same 32 gathered accesses wait together; and on each stall, in the share of the lines read from
/// front to back that miss the last cache. A thread shares the last level, so misses begin to cost when half
/// of it is full.
///
/// Of the jumps in a wait the first is no jump but the wait: one by itself is hidden by what a kernel
/// computes meanwhile, many together are not. A stall is a jump of the first cache.
///
/// A product computes next to nothing: all its jumps cost, and it waits for the last cache alone. Its stalls
/// are RunReuse::stalls, and in their share jumps of the first two caches cost nothing but the stalls that
/// they make: while memory is waited for, they are served.
struct KernelCosts {
  double access = 0.0;
  std::array<double, 4> miss{};
  std::array<double, 4> jump{};
  double repeat = 0.0;
  std::array<double, 3> wait{};  ///< of the second cache, half of the last and all of it
  double stall = 0.0;

  bool operator==(const KernelCosts&) const = default;
};

/// Numbers, one for each cost.
using CostRow = std::array<double, 14>;

/// The costs as a row, and costs from one.
CostRow as_row(const KernelCosts& costs);
KernelCosts as_costs(const CostRow& row);

/// Costs of the kernels on a machine.
struct CostModel {
  std::string machine;  ///< in words, "2-core Zen 5, 48 KB L1, 1 MB L2, 32 MB L3"
  Caches caches;        ///< what the costs belong to
  /// That share each run, as KernelBench does. With several the costs are those of elapsed time, for the
  /// accesses that one thread would make, times `times_computed`.
  int threads = 1;
  /// Whether stalls are counted, and waits as above. When some of the costs that ship were fitted, there were
  /// no stalls, and all jumps counted, beside waits for the last cache alone.
  bool stalls = true;
  std::array<KernelCosts, kKernels.size()> solid;  ///< of meshes of tetrahedra
  std::array<KernelCosts, kKernels.size()> flat;   ///< of meshes of triangles and edges

  [[nodiscard]] const KernelCosts& costs(Kernel kernel, int dimension) const noexcept {
    return (dimension == 3 ? solid : flat)[static_cast<std::size_t>(kernel)];
  }

  bool operator==(const CostModel&) const = default;
};

/// Returns the sizes of the four caches that costs are of: with one or two levels the last one also counts as
/// the second; with four or more only the first two and the last count. Throws InvalidArgument without
/// caches.
std::array<Offset, 4> sizes_that_cost(const Caches& caches);

/// Returns how often each cost occurs in a run, for caches of the sizes of sizes_that_cost. Waits are counted
/// as if the jumps were spread evenly over the gathered accesses. `stalls` as in CostModel. O(levels · bins
/// of the histograms).
CostRow counts_of(const RunReuse& reuse, const std::array<Offset, 4>& sizes, bool stalls = true);

/// Returns costs that benchmarks/fit_cost_model fitted to measurements on a 2-core Zen 5 server processor (48
/// KB L1, 1 MB L2, 32 MB L3). docs/prediction.md shows how well they predict other meshes.
const CostModel& zen5_costs();

/// Returns costs that `meshorder calibrate` measured on a 2-core Zen 4 server processor (32 KB L1, 1 MB L2,
/// 20 MB to be had of L3).
const CostModel& zen4_costs();

/// Returns costs that `meshorder calibrate` measured on a 2-core AMD EPYC of the Zen 3 family (32 KB L1, 512
/// KB L2, 12 MB to be had of 32 MB L3), with AVX2.
const CostModel& zen3_costs();

/// Returns costs that `meshorder calibrate` measured on a 2-core Intel Xeon of the Sapphire Rapids family (48
/// KB L1, 2 MB L2, 64 MB to be had of L3).
const CostModel& xeon_costs();

/// Predicts the milliseconds of each run of a repeated kernel on a processor with these caches (see
/// sizes_that_cost). Use the ratio of two orders of one mesh: the milliseconds are those of the model's
/// machine. O(levels · bins of the histograms). Throws InvalidArgument without caches.
double predicted_ms(const RunReuse& reuse, const Caches& caches, const CostModel& model = zen5_costs());

/// As above, for all kernels.
KernelMilliseconds predicted_ms(const KernelReuse& reuse, const Caches& caches,
                                const CostModel& model = zen5_costs());

}  // namespace meshorder
