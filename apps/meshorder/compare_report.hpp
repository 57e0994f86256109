// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "mesh/reorder.hpp"
#include "metrics/cache.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_timing.hpp"
#include <meshorder/layouts.hpp>
#include <meshorder/payoff.hpp>

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
  double seconds = 0;  ///< cost of the order: graph and both methods; 0 for the file's own
  EdgeSpan span;
  std::optional<KernelReuse> reuse;      ///< of repeated runs; none if not wanted or if the mesh is large
  std::optional<Iterations> iterations;  ///< likewise, only with --details
  std::vector<GpuCost> gpu;              ///< of additions in each of `Comparison::gpu_layouts`
};

/// Kernels measured with a number of threads.
struct KernelTable {
  int threads = 1;
  std::vector<OrderTimes> orders;  ///< the file's own first
  OrderTimes band;
  Steadiness steadiness;
  std::vector<double> redundancy;  ///< of each order, see KernelBench::redundancy
};

/// The compared orders, the file's own first, and for reference the band of the mesh's size (see
/// `ideal_band`).
struct Comparison {
  std::string file;
  std::string size;  ///< in words
  Caches caches;     ///< caches for which misses are predicted
  KernelSet kernel_set = KernelSet::plain;
  Workload workload = Workload::all;   ///< what the orders optimise
  std::vector<GpuLayout> gpu_layouts;  ///< for which additions on a graphics processor are counted
  std::vector<ComparedOrder> orders;
  EdgeSpan band_span;
  std::vector<KernelTable> kernels;
  std::span<const Kernel> kernels_run = kKernels;  ///< see kernels_of; only products for a matrix

  [[nodiscard]] bool is_matrix() const noexcept { return kernels_run.size() < kKernels.size(); }
};

/// Prints the best order, the command that makes it, and the speedup of each order over the file's
/// own.
void print_comparison(const Console& console, const Comparison& comparison);

/// Prints costs and spans, predicted misses, and the times of kernels for each number of threads.
void print_comparison_details(Console& console, const Comparison& comparison);

/// Returns the keys that docs/json.md lists, without those of the file.
nlohmann::ordered_json to_json(const Comparison& comparison);

}  // namespace meshorder::command
