// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/advice.hpp"

#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "base/stopwatch.hpp"
#include "kernels/simplices.hpp"
#include "mesh/reorder.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/sparsity_pattern.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/cost_model.hpp"
#include "payoff/kernel_timing.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

/// A mesh in one of the orders.
struct Ordered {
  Mesh mesh;  ///< points and cells
  CsrGraph graph;
};

/// The predictions for all orders, every kernel of every order on a thread of its own.
std::vector<KernelMilliseconds> predictions(const std::vector<Ordered>& orders,
                                            const AdviceOptions& options) {
  report("predict");
  std::vector<Simplices> simplices;
  simplices.reserve(orders.size());
  for (const Ordered& order : orders) simplices.push_back(cut_into_simplices(order.mesh));
  const Caches& caches = options.caches.level_bytes.empty() ? options.machine.model.caches : options.caches;
  const int halvings = simplices.front().size() < options.sample_from ? 0 : options.halvings;
  std::vector<KernelMilliseconds> result(orders.size());
  const Index kernels = index_size(kKernels);
  for_each_chunk(kernels * index_size(orders), 1, [&](Index task, Index /*begin*/, Index /*end*/) {
    const Index i = task % index_size(orders);
    const Index k = task / index_size(orders);
    const Reuse reuse = reuse_of(kKernels[k], orders[i].graph, simplices[i], halvings);
    result[i][k] = predicted_ms(kKernels[k], reuse, caches, options.machine.model);
  });
  return result;
}

/// In rounds that end by `seconds` on the stopwatch. `doubt` receives why they are not to be trusted.
std::vector<KernelMilliseconds> measurements(const std::vector<Ordered>& orders, const Stopwatch& stopwatch,
                                             double seconds, std::string& doubt) {
  report("measure");
  std::vector<std::optional<KernelBench>> benches(orders.size());
  for_each_chunk(index_size(orders), 1, [&](Index i, Index /*begin*/, Index /*end*/) {
    benches[i].emplace(orders[i].mesh, orders[i].graph);
  });
  std::vector<KernelBench*> pointers;
  pointers.reserve(benches.size());
  for (std::optional<KernelBench>& bench : benches) pointers.push_back(&bench.value());
  const Timings timings =
      time_interleaved(pointers, {.budget_seconds = std::max(0.0, seconds - stopwatch.seconds()),
                                  .min_rounds = 2,
                                  .sample_seconds = 0.01});
  doubt = reason_to_doubt(timings.steadiness);
  std::vector<KernelMilliseconds> result(orders.size());
  for (std::size_t i = 0; i < orders.size(); ++i) {
    for (std::size_t k = 0; k < kKernels.size(); ++k) result[i][k] = timings.orders[i][kKernels[k]].best_ms;
  }
  return result;
}

/// What is asked for of `compute_reordering`, one after another.
std::vector<ReorderOptions> asked_for(const AdviceOptions& options) {
  std::vector<ReorderOptions> result;
  for (const MeshMethods& methods : options.methods) {
    result.push_back({.methods = methods, .order = options.ordering});
  }
  if (!result.empty()) return result;
  result.assign(options.for_springs_too ? 2 : 1, {.order = options.ordering});
  result.front().order.workload = Workload::all;
  if (options.for_springs_too) result.back().order.workload = Workload::springs;
  return result;
}

/// Whether two candidates are one, taken for different uses.
bool are_one(const Candidate& a, const Candidate& b) {
  return a.vertices.name == b.vertices.name && a.elements.name == b.elements.name;
}

}  // namespace

Advice advise(const Mesh& mesh, const CsrGraph& graph, const AdviceOptions& options) {
  if (!options.predict && !options.measure_within) {
    throw InvalidArgument("advice: neither predicted nor measured");
  }
  const Stopwatch since_call;
  Advice advice;
  advice.as_is.vertices.name = advice.as_is.elements.name = "original";
  std::vector<Ordered> orders(1);
  orders.front().mesh.points = mesh.points;
  orders.front().mesh.cells = mesh.cells;
  orders.front().graph = graph;
  for (const ReorderOptions& reordering : asked_for(options)) {
    const Stopwatch stopwatch;
    const MeshOrder order = compute_reordering(mesh, graph, reordering);
    Ordered ordered = orders.front();
    apply_reordering(ordered.mesh, order);
    Candidate candidate{.vertices = order.vertices.method,
                        .elements = order.cells.method,
                        .workload = reordering.order.workload};
    const bool moves_nothing = are_one(candidate, advice.as_is);
    if (!moves_nothing) candidate.order_seconds = options.graph_seconds + stopwatch.seconds();
    if (options.methods.empty() && !advice.candidates.empty() &&
        are_one(advice.candidates.front(), candidate)) {
      continue;
    }
    ordered.graph = renumbered(graph, order.vertices.permutation.old_to_new());
    orders.push_back(std::move(ordered));
    advice.candidates.push_back(std::move(candidate));
  }
  const auto candidate = [&](std::size_t i) -> Candidate& {
    return i == 0 ? advice.as_is : advice.candidates[i - 1];
  };
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const Permutation as_ordered = Permutation::identity(orders[i].graph.size());
    candidate(i).spans = quality_of(orders[i].graph, as_ordered);
    candidate(i).pattern = pattern_of(orders[i].graph, as_ordered, kPatternSide);
  }
  if (options.predict) {
    advice.machine = options.machine.in_words();
    const std::vector<KernelMilliseconds> predicted = predictions(orders, options);
    for (std::size_t i = 0; i < orders.size(); ++i) candidate(i).costs.predicted = predicted[i];
  }
  if (options.measure_within) {
    const std::vector<KernelMilliseconds> measured =
        measurements(orders, since_call, *options.measure_within, advice.doubt);
    for (std::size_t i = 0; i < orders.size(); ++i) candidate(i).costs.measured = measured[i];
  }
  advice.floor = options.machine.floor;
  advice.kernels = kernel_advice(advice);
  return advice;
}

double same_time(const Advice& advice, Kernel kernel) {
  const double predicted = kernel == Kernel::spmv ? 1.25 : 1.1;
  return std::max(advice.as_is.costs.measured ? 1.05 : predicted,
                  1 + advice.floor[static_cast<std::size_t>(kernel)]);
}

std::array<KernelAdvice, kKernels.size()> kernel_advice(const Advice& advice) {
  std::array<KernelAdvice, kKernels.size()> result;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    KernelAdvice& of_kernel = result[k];
    const double as_is = advice.as_is.costs.best_known()[k];
    double best = as_is;
    for (std::size_t i = 0; i < advice.candidates.size(); ++i) {
      const double ms = advice.candidates[i].costs.best_known()[k];
      if (ms >= best) continue;
      best = ms;
      of_kernel.candidate = i;
    }
    if (best <= 0.0 || as_is < same_time(advice, kKernels[k]) * best) continue;
    of_kernel.factor = as_is / best;
    of_kernel.runs_to_pay =
        std::ceil(1e3 * advice.candidates[of_kernel.candidate].order_seconds / (as_is - best));
  }
  return result;
}

double saved_in_time_step(const Advice& advice, std::size_t candidate) {
  double saved = 0;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    const double as_is = advice.as_is.costs.best_known()[k];
    const double ordered = advice.candidates[candidate].costs.best_known()[k];
    const double same = same_time(advice, kKernels[k]);
    if (std::max(as_is, ordered) < same * std::min(as_is, ordered)) continue;
    saved += kRunsInTimeStep[k] * (as_is - ordered);
  }
  return saved;
}

double steps_to_pay(const Advice& advice, std::size_t candidate) {
  const double saved = saved_in_time_step(advice, candidate);
  return saved > 0 ? std::ceil(1e3 * advice.candidates[candidate].order_seconds / saved) : 0;
}

}  // namespace meshorder
