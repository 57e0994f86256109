// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "mesh/reorder.hpp"
#include "metrics/cache.hpp"
#include "metrics/edge_span.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_timing.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {

/// One order in the comparison: its names, what it cost and how good it is.
struct ComparedOrder {
  std::string vertices;
  std::string elements;
  Reordering order;
  EdgeSpan span;
  std::optional<KernelReuse> reuse;  ///< in the steady state; none for a large mesh
};

/// Kernels measured on some number of threads.
struct KernelTable {
  int threads = 1;
  std::vector<OrderTimes> orders;  ///< the reference first
  OrderTimes floor;                ///< of the ideal band
  std::vector<double> redundancy;  ///< of each order: see KernelBench::redundancy
};

/// The orders, the first of which is the reference, and the band of the mesh's size, which is none of them.
struct Comparison {
  Caches caches;  ///< for which misses are predicted
  std::vector<ComparedOrder> orders;
  EdgeSpan floor_span;
  std::vector<KernelTable> kernels;
};

/// Costs and spans, and a table of kernels for each number of threads.
void print_comparison(const Console& console, const Comparison& comparison);

/// "methods" and "floor", as docs/json.md has them.
nlohmann::ordered_json to_json(const Comparison& comparison);

}  // namespace meshorder::command
