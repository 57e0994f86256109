// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/study/cost_model.hpp>

#include <algorithm>

namespace meshorder {
namespace {

// printed by benchmarks/fit_cost_model/fit.py from data-2core-zen5.csv beside it
constexpr CostModel kZen5{.machine = "2-core Zen 5, 48 KB L1, 1 MB L2, 32 MB L3",
                          .kernels = {{
                              {.access = 1, .miss = {1, 1, 1}, .jump = {1, 1, 1}},  // spmv
                              {.access = 1, .miss = {1, 1, 1}, .jump = {1, 1, 1}},  // element
                              {.access = 1, .miss = {1, 1, 1}, .jump = {1, 1, 1}},  // assembly
                              {.access = 1, .miss = {1, 1, 1}, .jump = {1, 1, 1}},  // springs
                          }}};

}  // namespace

const CostModel& zen5_costs() { return kZen5; }

double predicted_ms(Kernel kernel, const Reuse& reuse, const Caches& caches, const CostModel& model) {
  if (caches.level_bytes.empty()) throw InvalidArgument("cost model: no caches");
  const KernelCosts& costs = model.kernels[static_cast<std::size_t>(kernel)];
  const std::vector<Offset> missed = misses(reuse.all, caches);
  const std::vector<Offset> jumped = misses(reuse.jumps, caches);
  const std::size_t last = missed.size() - 1;
  double nanoseconds = costs.access * static_cast<double>(reuse.all.accesses());
  for (std::size_t i = 0; i < costs.miss.size(); ++i) {
    const std::size_t level = i + 1 < costs.miss.size() ? std::min(i, last) : last;
    nanoseconds += costs.miss[i] * static_cast<double>(missed[level]);
    nanoseconds += costs.jump[i] * static_cast<double>(jumped[level]);
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
