// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_timing.hpp"
#include <meshorder/order.hpp>
#include <meshorder/payoff.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Options of `compare_orders`.
struct MeshComparisonOptions {
  std::vector<MeshMethods> methods = {};  ///< orders besides the mesh's own
  bool only_new = false;                  ///< leave out methods after `auto` that `auto` chose
  OrderOptions ordering = {};
  KernelSet kernels = KernelSet::plain;
  int threads = 1;  ///< the kernels run on one thread and, if there are more, on all of them
  /// Seconds for the orders and the runs of kernels together; two rounds run even if they take longer.
  double budget_seconds = TimingOptions{}.budget_seconds;
  bool reuse = false;           ///< compute `reuse` if the mesh has at most two million simplices
  bool reuse_of_large = false;  ///< compute `reuse` also for larger meshes
  bool iterations = false;      ///< compute `iterations` wherever `reuse` is computed
  /// Called at the beginning of each stage; the stage takes the share `from` … `to` of the whole call.
  std::function<void(const std::string& stage, double from, double to)> begins = {};
};

/// An order in a comparison: its methods, its cost and its quality.
struct ComparedMeshOrder {
  MeshMethods asked;
  MeshOrder order;
  double seconds = 0;  ///< cost of the order: graph and both methods; 0 for the mesh's own
  EdgeSpan span = {};
  std::optional<KernelReuse> reuse = {};      ///< reuse in repeated runs
  std::optional<Iterations> iterations = {};  ///< iterations of the solvers that depend on the order
};

/// Kernels measured with a number of threads.
struct KernelTable {
  int threads = 1;
  std::vector<OrderTimes> orders;  ///< the first is the mesh's own
  OrderTimes again;                ///< the mesh's own, timed once more
  OrderTimes band;
  Steadiness steadiness;
  std::vector<double> redundancy;  ///< KernelBench::redundancy of each order
};

/// The compared orders and, for reference, the band of the mesh's size (see `ideal_band`).
struct MeshComparison {
  KernelSet kernel_set = KernelSet::plain;
  Workload workload = Workload::all;           ///< what the orders optimise
  std::vector<ComparedMeshOrder> orders;       ///< the first is the mesh's own
  std::optional<MeshMethods> auto_keeps = {};  ///< the methods that `auto` chose if it kept the first order
  EdgeSpan band_span;
  std::vector<KernelTable> kernels;                ///< on one thread, then on several
  std::span<const Kernel> kernels_run = kKernels;  ///< see kernels_of; only products for a matrix

  [[nodiscard]] bool is_matrix() const noexcept { return kernels_run.size() < kKernels.size(); }
};

/// Computes the mesh's own order and the other orders, each once. Times the kernels in all orders and on the
/// band, in interleaved rounds. Cuts the mesh into simplices once, and builds its graph once.
///
/// @throws as `compute_order_in_file` and `prepare_kernels`
MeshComparison compare_orders(const Mesh& mesh, const MeshComparisonOptions& options);

/// Returns a sentence that lists the times for which only a part of the elements ran (`KernelTimes::share`);
/// empty if there are none.
std::string parts_in_words(const MeshComparison& comparison);

/// Returns advice on the mesh from the times on the largest number of threads; the other orders are the
/// candidates.
Advice advice_of(const MeshComparison& comparison);

}  // namespace meshorder
