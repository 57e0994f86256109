// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "mesh/reorder.hpp"
#include "metrics/cache.hpp"
#include "metrics/edge_span.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_timing.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace meshorder::command {

/// An order in the comparison: its methods, its cost and its quality.
struct ComparedOrder {
  std::string vertices;
  std::string elements;
  MeshOrder order;
  EdgeSpan span;
  std::optional<KernelReuse> reuse;  ///< of a repeated run; none for a large mesh
};

/// Kernels measured with a number of threads.
struct KernelTable {
  int threads = 1;
  std::vector<OrderTimes> orders;  ///< the reference first
  OrderTimes floor;                ///< on the ideal band
  Steadiness steadiness;
  std::vector<double> redundancy;  ///< in each order, see KernelBench::redundancy
};

/// The orders, the first of which is the reference, and the band of the mesh's size, a lower bound.
struct Comparison {
  Caches caches;  ///< for which misses are predicted
  KernelSet kernel_set = KernelSet::plain;
  std::vector<ComparedOrder> orders;
  EdgeSpan floor_span;
  std::vector<KernelTable> kernels;
  std::span<const Kernel> kernels_run = kKernels;  ///< see kernels_of; products alone of a matrix

  [[nodiscard]] bool is_matrix() const noexcept { return kernels_run.size() < kKernels.size(); }
};

/// Prints costs and spans, predicted misses, and a table of kernels for each number of threads.
void print_comparison(Console& console, const Comparison& comparison);

/// Returns the keys that docs/json.md lists, but for those of the file.
nlohmann::ordered_json to_json(const Comparison& comparison);

}  // namespace meshorder::command
