// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"
#include "metrics/reuse_distance.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_bench.hpp"

#include <array>
#include <string>

namespace meshorder {

/// Nanoseconds (≥ 0) that a kernel spends on each access, each miss, each jump and each turn
/// (RunReuse::turns). A jump is a miss that no hardware prefetcher predicts; its cost is added to that of the
/// miss. Misses and jumps are counted for four caches: the first level, the second level, half of the last
/// level and all of the last level. A thread shares the last level, so misses begin to cost when half of it
/// is full. Jumps that miss the whole last cache are first touches out of order: at most one in a run for
/// each line of the vectors.
struct KernelCosts {
  double access = 0.0;
  std::array<double, 4> miss{};
  std::array<double, 4> jump{};
  double turn = 0.0;

  bool operator==(const KernelCosts&) const = default;
};

/// A number for each cost of KernelCosts.
using CostRow = std::array<double, 10>;

/// Returns the costs as a row; as_costs is the inverse.
CostRow as_row(const KernelCosts& costs);
KernelCosts as_costs(const CostRow& row);

/// Costs of the kernels on a machine.
struct CostModel {
  std::string machine;  ///< in words, "2-core Zen 5, 48 KB L1, 1 MB L2, 32 MB L3"
  Caches caches;        ///< caches of that machine, to which the costs refer
  /// Number of threads that share each run (KernelBench). With several, the costs predict the elapsed time
  /// from the accesses that one thread would make; the prediction is then multiplied by `times_computed`.
  int threads = 1;
  std::array<KernelCosts, kKernels.size()> solid;  ///< costs for meshes of tetrahedra
  std::array<KernelCosts, kKernels.size()> flat;   ///< costs for meshes of triangles and edges

  [[nodiscard]] const KernelCosts& costs(Kernel kernel, int dimension) const noexcept {
    return (dimension == 3 ? solid : flat)[static_cast<std::size_t>(kernel)];
  }

  bool operator==(const CostModel&) const = default;
};

/// Returns the sizes of the four caches that costs refer to. If there is only one level, it is also used as
/// the second; if there are two, the second is also the last; if there are four or more, only the first two
/// and the last are used. Throws InvalidArgument without caches.
std::array<Offset, 4> sizes_that_cost(const Caches& caches);

/// Returns how often each cost occurs in a run; `sizes` as from sizes_that_cost. O(levels · bins of the
/// histograms).
CostRow counts_of(const RunReuse& reuse, const std::array<Offset, 4>& sizes);

/// Returns costs that `meshorder calibrate` measured on a 2-core AMD EPYC of the Zen 3 family (32 KB L1,
/// 512 KB L2, 16 MB available of 32 MB L3). docs/prediction.md reports their errors.
const CostModel& zen3_costs();

/// Predicts the milliseconds of each run of a repeated kernel on a processor with these caches (see
/// sizes_that_cost). The costs are those of the model's machine, so use the ratio of two orders of one mesh
/// rather than the milliseconds. O(levels · bins of the histograms). Throws InvalidArgument without caches.
double predicted_ms(const RunReuse& reuse, const Caches& caches, const CostModel& model = zen3_costs());

/// Predicts the milliseconds of all kernels in the same way.
KernelMilliseconds predicted_ms(const KernelReuse& reuse, const Caches& caches,
                                const CostModel& model = zen3_costs());

}  // namespace meshorder
