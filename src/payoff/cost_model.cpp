// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/cost_model.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <vector>

namespace meshorder {

const CostModel& zen5_costs() {
  // printed by benchmarks/fit_cost_model/fit.py from data-2core-zen5.csv beside it
  static const CostModel model{
      .machine = "2-core Zen 5, 48 KB L1, 1 MB L2, 32 MB L3",
      .caches = parse_cache_sizes("48K,1M,32M"),
      .kernels = {{
          {.access = 0.1618, .miss = {0.206, 0.2589, 0.07844, 0.4239}, .jump = {0, 0, 2.657, 0}},   // spmv
          {.access = 0.5038, .miss = {0, 0.01054, 1.415, 0}, .jump = {0.06757, 0.8356, 7.661, 0}},  // element
          {.access = 0.7606, .miss = {0, 0, 0, 1.038}, .jump = {1.024, 0.6349, 2.869, 0}},        // assembly
          {.access = 0.4856, .miss = {0, 0, 0.5409, 0}, .jump = {0.03403, 0.298, 7.274, 6.446}},  // springs
      }}};
  return model;
}

const CostModel& zen4_costs() {
  // printed by `meshorder calibrate --json` on the idle machine
  static const CostModel model{
      .machine = "2-core Zen 4, 32 KB L1, 1 MB L2, 25 MB to be had of 32 MB L3",
      .caches = parse_cache_sizes("32K,1M,26008K"),
      .kernels = {{
          {.access = 0.525,
           .miss = {0, 0.1117, 0.2055, 0.114},
           .jump = {0.3934, 0.3549, 3.069, 18.49}},  // spmv
          {.access = 0.7168,
           .miss = {0, 0, 0, 0},
           .jump = {0.2779, 1.325, 6.369, 63.88},
           .repeat = 1.565},                                                             // element
          {.access = 1.316, .miss = {0, 0, 0, 0}, .jump = {1.082, 2.633, 2.28, 14.22}},  // assembly
          {.access = 0.9295, .miss = {0, 0, 0, 0.2698}, .jump = {0, 0.3241, 18.33, 0}},  // springs
      }}};
  return model;
}

std::array<Offset, 4> sizes_that_cost(const Caches& caches) {
  const std::vector<Offset>& levels = caches.level_bytes;
  if (levels.empty()) throw InvalidArgument("cost model: no caches");
  return {levels.front(), levels[std::min<std::size_t>(1, levels.size() - 1)], levels.back() / 2,
          levels.back()};
}

double predicted_ms(Kernel kernel, const RunReuse& reuse, const Caches& caches, const CostModel& model) {
  const KernelCosts& costs = model.kernels[static_cast<std::size_t>(kernel)];
  const std::array<Offset, 4> sizes = sizes_that_cost(caches);
  double nanoseconds = costs.access * static_cast<double>(reuse.all.accesses()) +
                       costs.repeat * static_cast<double>(reuse.repeats);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    nanoseconds += costs.miss[i] * static_cast<double>(reuse.all.misses(sizes[i] / kLineBytes));
    nanoseconds += costs.jump[i] * static_cast<double>(reuse.jumps.misses(sizes[i] / kLineBytes));
  }
  return 1e-6 * nanoseconds;
}

KernelMilliseconds predicted_ms(const KernelReuse& reuse, const Caches& caches, const CostModel& model) {
  KernelMilliseconds result{};
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    result[k] = predicted_ms(kKernels[k], reuse[k], caches, model);
  }
  return result;
}

}  // namespace meshorder
