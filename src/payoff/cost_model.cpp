// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/cost_model.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace meshorder {

const CostModel& zen5_costs() {
  // printed by benchmarks/fit_cost_model/fit.py from data-2core-zen5.csv beside it
  static const CostModel model{
      .machine = "2-core Zen 5, 48 KB L1, 1 MB L2, 32 MB L3",
      .caches = parse_cache_sizes("48K,1M,32M"),
      .stalls = false,
      .solid = {{
          {.access = 0.03582,
           .miss = {0.264, 0.442, 0.08801, 0.2538},
           .jump = {0, 0, 0, 0},
           .wait = {0, 0, 27.69}},  // spmv
          {.access = 0.2224,
           .miss = {0.02055, 1.83, 1.042, 0},
           .jump = {0.0535, 0, 3.241, 0},
           .wait = {0, 0, 40.08}},  // element
          {.access = 0.6869,
           .miss = {0.1201, 0.4412, 0.6889, 0},
           .jump = {0.8737, 0, 0.6091, 2.157},
           .wait = {0, 0, 3.446}},                                                                 // assembly
          {.access = 0.4631, .miss = {0.01272, 0.3411, 0.3603, 0}, .jump = {0, 0, 6.897, 9.478}},  // springs
      }},
      .flat = {{
          {.access = 0.03099,
           .miss = {0.1883, 0.5413, 0.1304, 0.2113},
           .jump = {0, 0, 0.2776, 0},
           .wait = {0, 0, 26.12}},  // spmv
          {.access = 0.4801,
           .miss = {0, 0.04593, 1.134, 0},
           .jump = {0.1071, 0.8144, 5.951, 0},
           .repeat = 0.1944,
           .wait = {0, 0, 33.65}},  // element
          {.access = 0.7647,
           .miss = {0, 0, 0, 0.5728},
           .jump = {1.111, 0.635, 3.112, 0},
           .wait = {0, 0, 5.692}},                                                                 // assembly
          {.access = 0.4856, .miss = {0, 0, 0.5416, 0}, .jump = {0.03384, 0.2992, 7.262, 6.648}},  // springs
      }}};
  return model;
}

const CostModel& zen4_costs() {
  // printed by `meshorder calibrate --json`
  static const CostModel model{.machine = "2-core Zen 4, 32 KB L1, 1 MB L2, 20 MB to be had of 32 MB L3",
                               .caches = parse_cache_sizes("32K,1M,20642K"),
                               .solid = {{
                                   {.access = 0.2937,
                                    .miss = {0.3564, 0.05428, 0.1531, 0},
                                    .jump = {0, 2.134, 2.311, 9.352},
                                    .wait = {0, 0, 3.903},
                                    .stall = 11.31},  // spmv
                                   {.access = 0.7116,
                                    .miss = {0.2611, 0.08151, 0.1144, 0.0615},
                                    .jump = {0, 0.2946, 5.208, 0},
                                    .repeat = 1.073,
                                    .wait = {2.626, 0, 0},
                                    .stall = 0.7817},  // element
                                   {.access = 1.222,
                                    .miss = {0.4929, 0, 0, 0},
                                    .jump = {0, 1.173, 8.433, 8.284},
                                    .wait = {5.224, 7.533, 0},
                                    .stall = 0.1728},  // assembly
                                   {.access = 0.6285,
                                    .miss = {0, 0.1745, 0.1675, 0.2917},
                                    .jump = {0.1173, 0.1136, 0, 1.194},
                                    .wait = {2.238, 4.627, 0}},  // springs
                               }},
                               .flat = {{
                                   {.access = 0.2856,
                                    .miss = {0.3706, 0.0782, 0.1612, 0},
                                    .jump = {0, 0.531, 2.22, 7.372},
                                    .wait = {0, 0, 4.904},
                                    .stall = 10.98},  // spmv
                                   {.access = 0.7539,
                                    .miss = {0, 0, 0.3095, 0.006963},
                                    .jump = {0.2509, 0.2979, 5.003, 0},
                                    .repeat = 0.9635,
                                    .wait = {2.108, 0, 0},
                                    .stall = 0.8589},  // element
                                   {.access = 1.273,
                                    .miss = {0.3157, 0, 0, 0},
                                    .jump = {0, 1.496, 1.221, 14.27},
                                    .wait = {4.583, 0, 0},
                                    .stall = 2.758},  // assembly
                                   {.access = 0.6282,
                                    .miss = {0, 0, 0.4276, 0.2189},
                                    .jump = {0.1258, 0.314, 0, 1.699},
                                    .wait = {2.133, 3.877, 0}},  // springs
                               }}};
  return model;
}

const CostModel& zen3_costs() {
  // printed by `meshorder calibrate --json`
  static const CostModel model{
      .machine = "2-core Zen 3, 32 KB L1, 512 KB L2, 12 MB to be had of 32 MB L3",
      .caches = parse_cache_sizes("32K,512K,13004K"),
      .stalls = false,
      .solid = {{
          {.access = 0.7382,
           .miss = {0.2113, 0.04868, 0.03762, 2.956},
           .jump = {0.1472, 1.413, 0.4322, 0}},  // spmv
          {.access = 1.168,
           .miss = {0.1101, 0.05991, 0.4114, 0},
           .jump = {0.2047, 1.259, 3.717, 0},
           .repeat = 2.662,
           .wait = {0, 0, 176.8}},  // element
          {.access = 1.708,
           .miss = {0.8522, 1.101, 0, 0},
           .jump = {0.2004, 1.326, 7.63, 19.99},
           .wait = {0, 0, 5.477}},  // assembly
          {.access = 0.8357,
           .miss = {0.09984, 0.4368, 3.843, 0},
           .jump = {0.08905, 1.047, 1.205, 0}},  // springs
      }},
      .flat = {{
          {.access = 0.8118, .miss = {0.0502, 0, 0, 1.33}, .jump = {0.5701, 1.505, 6.062, 0}},  // spmv
          {.access = 1.166,
           .miss = {0, 0, 0.8755, 0},
           .jump = {0.37, 0.8664, 4.973, 0},
           .repeat = 2.604,
           .wait = {0, 0, 160.8}},                                                               // element
          {.access = 1.994, .miss = {0, 0, 0, 0}, .jump = {0.8172, 5.472, 0, 23.7}},             // assembly
          {.access = 0.8672, .miss = {0, 0.0424, 4.263, 0}, .jump = {0.2291, 1.151, 1.431, 0}},  // springs
      }}};
  return model;
}

const CostModel& xeon_costs() {
  // printed by `meshorder calibrate --json`
  static const CostModel model{
      .machine = "2-core Sapphire Rapids, 48 KB L1, 2 MB L2, 64 MB to be had of L3",
      .caches = parse_cache_sizes("48K,2M,64M"),
      .stalls = false,
      .solid = {{
          {.access = 0.4931, .miss = {0, 1.145, 0, 0.5293}, .jump = {0, 2.443, 0, 0}},  // spmv
          {.access = 0.5071,
           .miss = {0, 0.5205, 0, 0.4381},
           .jump = {0.6262, 1.973, 0, 0},
           .repeat = 1.17},  // element
          {.access = 0.8739,
           .miss = {0.6189, 0.1833, 0.8413, 0.5366},
           .jump = {0, 5.816, 4.354, 3.215}},                                               // assembly
          {.access = 0.3914, .miss = {0, 0.47, 0.2112, 0}, .jump = {0.2115, 1.387, 0, 0}},  // springs
      }},
      .flat = {{
          {.access = 0.4931, .miss = {0, 1.151, 0, 0.5276}, .jump = {0, 2.412, 0, 0}},  // spmv
          {.access = 0.5158,
           .miss = {0, 0.5637, 0, 0.4416},
           .jump = {0.6437, 1.878, 0, 0},
           .repeat = 1.011},                                                                       // element
          {.access = 0.916, .miss = {0.3455, 0, 1.547, 0}, .jump = {0.4944, 5.121, 4.981, 3.42}},  // assembly
          {.access = 0.3923, .miss = {0, 0.4265, 0.2623, 0}, .jump = {0.2197, 1.425, 0, 0}},       // springs
      }}};
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
  row[9] = costs.repeat;
  std::copy(costs.wait.begin(), costs.wait.end(), row.begin() + 10);
  row[13] = costs.stall;
  return row;
}

KernelCosts as_costs(const CostRow& row) {
  KernelCosts costs{.access = row[0], .repeat = row[9], .stall = row[13]};
  std::copy_n(row.begin() + 1, costs.miss.size(), costs.miss.begin());
  std::copy_n(row.begin() + 5, costs.jump.size(), costs.jump.begin());
  std::copy_n(row.begin() + 10, costs.wait.size(), costs.wait.begin());
  return costs;
}

namespace {

/// How many groups of accesses under way at a time have a jump, if jumps are spread evenly.
double waits_for(double jumps, double gathers) {
  constexpr double kTogether = 32;
  // an estimate from a sample of the lines may be above the whole
  const double hits = std::max(0.0, 1 - jumps / gathers);
  return gathers / kTogether * (1 - std::pow(hits, kTogether));
}

}  // namespace

CostRow counts_of(const RunReuse& reuse, const std::array<Offset, 4>& sizes, bool stalls) {
  KernelCosts counts{.access = static_cast<double>(reuse.all.accesses()),
                     .repeat = static_cast<double>(reuse.repeats)};
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    counts.miss[i] = static_cast<double>(reuse.all.misses(sizes[i] / kLineBytes));
    counts.jump[i] = static_cast<double>(reuse.jumps.misses(sizes[i] / kLineBytes));
  }
  const bool is_product = reuse.kernel == Kernel::spmv;
  if (const auto gathers = static_cast<double>(reuse.gathers); gathers > 0) {
    if (is_product || !stalls) {
      counts.wait.back() = waits_for(counts.jump.back(), gathers);
    } else {
      for (std::size_t i = 0; i < counts.wait.size(); ++i) {
        counts.wait[i] = waits_for(counts.jump[i + 1], gathers);
        counts.jump[i + 1] = std::max(0.0, counts.jump[i + 1] - counts.wait[i]);
      }
    }
  }
  if (const Offset streamed = reuse.all.accesses() - reuse.gathers; stalls && streamed > 0) {
    const double share = std::min(1.0, counts.miss.back() / static_cast<double>(streamed));
    if (!is_product) {
      counts.stall = share * counts.jump[0];
    } else if (reuse.stalls > 0) {
      counts.stall = share * static_cast<double>(reuse.stalls);
      counts.jump[0] *= 1 - share;
      counts.jump[1] *= 1 - share;
    }
  }
  return as_row(counts);
}

double predicted_ms(const RunReuse& reuse, const Caches& caches, const CostModel& model) {
  const CostRow costs = as_row(model.costs(reuse.kernel, reuse.dimension));
  const CostRow counts = counts_of(reuse, sizes_that_cost(caches), model.stalls);
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
