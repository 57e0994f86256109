// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/cost_model.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

namespace meshorder {

const CostModel& zen3_costs() {
  // printed by `meshorder calibrate --json`
  static const CostModel model{.machine = "2-core Zen 3, 32 KB L1, 512 KB L2, 16 MB available of 32 MB L3",
                               .caches = parse_cache_sizes("32K,512K,16384K"),
                               .solid = {{{.access = 0.5756,
                                           .miss = {0, 0, 0.431, 2.37},
                                           .jump = {0.2369, 1.102, 8.262, 19.74},
                                           .turn = 1.846} /* spmv */,
                                          {.access = 3.191,
                                           .miss = {0, 0, 0, 0},
                                           .jump = {0, 1.093, 141.4, 48.52},
                                           .turn = 0} /* element */,
                                          {.access = 0.8627,
                                           .miss = {0.07315, 12.74, 21.2, 0},
                                           .jump = {1.013, 0, 69.02, 0},
                                           .turn = 11.93} /* assembly */,
                                          {.access = 1.212,
                                           .miss = {0, 2.243, 0, 2.643},
                                           .jump = {0.147, 1.016, 52.51, 0},
                                           .turn = 0} /* springs */}},
                               .flat = {{{.access = 0.5785,
                                          .miss = {0, 0.034, 0.3801, 2.197},
                                          .jump = {0.2089, 1.172, 9.014, 24.58},
                                          .turn = 1.84} /* spmv */,
                                         {.access = 3.124,
                                          .miss = {0, 0, 1.655, 0},
                                          .jump = {0.1979, 1.012, 139.3, 49.56},
                                          .turn = 0} /* element */,
                                         {.access = 1.208,
                                          .miss = {0.8274, 7.542, 15.53, 0},
                                          .jump = {0, 0, 91.96, 0},
                                          .turn = 9.984} /* assembly */,
                                         {.access = 1.269,
                                          .miss = {0, 0.598, 0, 3.015},
                                          .jump = {0.01538, 3.037, 55.84, 0},
                                          .turn = 0} /* springs */}}};
  return model;
}

std::array<Offset, 4> sizes_that_cost(const Caches& caches) {
  const std::vector<Offset>& levels = caches.level_bytes;
  if (levels.empty()) throw InvalidArgument("cost model: no caches");
  return {levels.front(), levels[std::min<std::size_t>(1, levels.size() - 1)], levels.back() / 2,
          levels.back()};
}

CostRow as_row(const KernelCosts& costs) {
  CostRow row{costs.access};
  std::copy(costs.miss.begin(), costs.miss.end(), row.begin() + 1);
  std::copy(costs.jump.begin(), costs.jump.end(), row.begin() + 5);
  row[9] = costs.turn;
  return row;
}

KernelCosts as_costs(const CostRow& row) {
  KernelCosts costs{.access = row[0], .turn = row[9]};
  std::copy_n(row.begin() + 1, costs.miss.size(), costs.miss.begin());
  std::copy_n(row.begin() + 5, costs.jump.size(), costs.jump.begin());
  return costs;
}

CostRow counts_of(const RunReuse& reuse, const std::array<Offset, 4>& sizes) {
  KernelCosts counts{.access = static_cast<double>(reuse.all.accesses()),
                     .turn = static_cast<double>(reuse.turns)};
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    counts.miss[i] = static_cast<double>(reuse.all.misses(sizes[i] / kLineBytes));
    counts.jump[i] = static_cast<double>(reuse.jumps.misses(sizes[i] / kLineBytes));
  }
  return as_row(counts);
}

double predicted_ms(const RunReuse& reuse, const Caches& caches, const CostModel& model) {
  const CostRow costs = as_row(model.costs(reuse.kernel, reuse.dimension));
  const CostRow counts = counts_of(reuse, sizes_that_cost(caches));
  return 1e-6 * std::inner_product(costs.begin(), costs.end(), counts.begin(), 0.0);
}

KernelMilliseconds predicted_ms(const KernelReuse& reuse, const Caches& caches, const CostModel& model) {
  KernelMilliseconds result{};
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    result[k] = predicted_ms(reuse[k], caches, model);
  }
  return result;
}

}  // namespace meshorder
