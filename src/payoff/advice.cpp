// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/advice.hpp"

#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "base/stopwatch.hpp"
#include "io/format.hpp"
#include "mesh/simplices.hpp"
#include "mesh/stored_matrix.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include "ordering/method.hpp"
#include "payoff/cost_model.hpp"
#include "payoff/kernel_bench.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// The orders of all candidates, each order once.
struct Orders {
  std::vector<KernelInput> all;            ///< the first one is the mesh as it is
  std::vector<std::size_t> of_candidates;  ///< the place in `all` of each candidate's order
};

/// Calls `call(candidate, place of its order)` for the mesh as it is and for each candidate.
template <class Call>
void for_candidates(Advice& advice, const Orders& orders, const Call& call) {
  call(advice.as_is, std::size_t{0});
  for (std::size_t i = 0; i < advice.candidates.size(); ++i)
    call(advice.candidates[i], orders.of_candidates[i]);
}

RunReuse reuse_in(const KernelInput& order, Kernel kernel, int halvings) {
  return order.is_matrix() ? reuse_of_product(order.pattern(), halvings)
                           : reuse_of(kernel, order.graph(), order.simplices(), halvings);
}

/// Returns the predictions for all orders. Each thread takes one kernel in one order at a time.
std::vector<KernelMilliseconds> predictions(const std::vector<KernelInput>& orders,
                                            const AdviceOptions& options) {
  report("predict");
  const Caches& caches = options.caches.level_bytes.empty() ? options.machine.model.caches : options.caches;
  const int halvings = options.halvings.value_or(halvings_for(orders.front().simplices().size()));
  const bool is_matrix = orders.front().is_matrix();
  std::vector<KernelMilliseconds> result(orders.size());
  take_turns((is_matrix ? 1 : index_size(kKernels)) * index_size(orders), [&](Index turn) {
    const Index i = turn % index_size(orders);
    const std::size_t k = is_matrix ? 0 : kLongestFirst[turn / index_size(orders)];
    const RunReuse reuse = i == 0 && options.reuse_as_is ? (*options.reuse_as_is)[k]
                                                         : reuse_in(orders[i], kKernels[k], halvings);
    result[i][k] = predicted_ms(reuse, caches, options.machine.model) *
                   times_computed(kKernels[k], orders[i].graph(), orders[i].simplices(), options.threads);
  });
  return result;
}

TimingOptions for_seconds(double seconds) {
  return {.budget_seconds = std::max(0.0, seconds), .min_rounds = 2, .sample_seconds = 0.01};
}

/// Times all orders together, in rounds that end within `options.measure_within` seconds on the stopwatch.
Timings measured(const std::vector<KernelInput>& orders, const AdviceOptions& options,
                 const Stopwatch& stopwatch) {
  std::vector<std::unique_ptr<KernelBench>> benches(orders.size());
  for_each_chunk(index_size(orders), 1, [&](Index i, Index /*begin*/, Index /*end*/) {
    benches[i] = prepare_kernels(options.kernels, orders[i], options.threads);
  });
  std::vector<KernelBench*> pointers;
  pointers.reserve(benches.size());
  for (const auto& bench : benches) pointers.push_back(bench.get());
  return time_interleaved(pointers, for_seconds(*options.measure_within - stopwatch.seconds()));
}

/// Times the orders with the race's timer, for half a second each.
Timings raced(const std::vector<KernelInput>& orders, const AdviceOptions& options) {
  constexpr double kSeconds = 0.5;
  const auto prepare = [&](Index i) { return prepare_kernels(options.kernels, orders[i], options.threads); };
  return options.race_timer(index_size(orders), prepare,
                            for_seconds(kSeconds * static_cast<double>(orders.size())));
}

/// Returns the options of each order to compute. Without `options.methods`, the orders are `auto` for all
/// kernels and, if `auto` chooses another method for springs, `auto` for springs.
std::vector<ReorderOptions> asked_for(const Mesh& mesh, const CsrGraph& graph, const AdviceOptions& options) {
  std::vector<ReorderOptions> result;
  for (const MeshMethods& methods : options.methods) {
    result.push_back({.methods = methods, .format = options.format, .order = options.ordering});
  }
  if (!result.empty()) return result;
  const auto method_for = [&](Workload workload) {
    return choose_vertex_method({graph, mesh.points}, workload).name;
  };
  const bool springs_apart = options.for_springs_too && stored_matrix(mesh) == nullptr &&
                             method_for(Workload::springs) != method_for(Workload::all);
  result.assign(springs_apart ? 2 : 1, {.order = options.ordering});
  result.front().order.workload = Workload::all;
  if (springs_apart) result.back().order.workload = Workload::springs;
  return result;
}

/// Returns whether two candidates have the same methods, and so are the same order.
bool are_one(const Candidate& a, const Candidate& b) {
  return a.vertices.name == b.vertices.name && a.elements.name == b.elements.name;
}

/// Returns log(time in an order / time in the mesh's own order), as the mean over the kernels of a workload.
/// Throws InvalidArgument if the workload has no kernels.
double cost_for(Workload workload, const Advice& advice, const OrderCosts& costs) {
  double sum = 0;
  int kernels = 0;
  for (std::size_t k = 0; k < kernels_of(advice).size(); ++k) {
    if (workload != Workload::all && to_string(workload) != to_string(kKernels[k])) continue;
    // a mesh of points has no work to do
    const double as_is = advice.as_is.costs.best_known()[k];
    if (as_is > 0) sum += std::log(costs.best_known()[k] / as_is);
    ++kernels;
  }
  if (kernels == 0) {
    throw InvalidArgument(fmt::format("advice: no kernel measures {}", to_string(workload)));
  }
  return sum / kernels;
}

/// Keeps `most` candidates in their present sequence: the first one and the best of the others.
void keep_best(Advice& advice, Orders& orders, Workload workload, std::size_t most) {
  std::vector<std::size_t> places(advice.candidates.size());
  std::iota(places.begin(), places.end(), 0);
  if (places.size() <= most) return;
  std::stable_sort(places.begin() + 1, places.end(), [&](std::size_t a, std::size_t b) {
    return cost_for(workload, advice, advice.candidates[a].costs) <
           cost_for(workload, advice, advice.candidates[b].costs);
  });
  places.resize(most);
  std::sort(places.begin(), places.end());
  std::vector<std::size_t>& order_of = orders.of_candidates;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == i) continue;
    advice.candidates[i] = std::move(advice.candidates[places[i]]);
    order_of[i] = order_of[places[i]];
  }
  advice.candidates.resize(most);
  order_of.resize(most);
  std::vector<KernelInput> kept;
  kept.push_back(std::move(orders.all.front()));
  for (std::size_t& place : order_of) {
    if (place == 0) continue;
    kept.push_back(std::move(orders.all[place]));
    place = kept.size() - 1;
  }
  orders.all = std::move(kept);
}

/// Throws InvalidArgument for options that contradict each other.
void check(const AdviceOptions& options) {
  if (!options.predict && !options.measure_within) {
    throw InvalidArgument("advice: neither predicted nor measured");
  }
  if (options.predict && options.machine.model.threads != options.threads) {
    throw InvalidArgument(fmt::format("advice: the costs are of {} threads, not of {}",
                                      options.machine.model.threads, options.threads));
  }
  if (options.predict && options.kernels != KernelSet::plain) {
    throw InvalidArgument("advice: tuned kernels are measured, not predicted");
  }
  if (options.race_of > 0 && !options.predict) throw InvalidArgument("advice: a race without predictions");
}

bool is_race(const AdviceOptions& options) { return options.race_of > 0 && options.race_timer; }

bool measures(const AdviceOptions& options) { return is_race(options) || options.measure_within; }

/// Computes the requested orders as candidates; skips repeats in a race or without `options.methods`.
void add_candidates(Advice& advice, Orders& orders, const Mesh& mesh, const AdviceOptions& options) {
  const CsrGraph& graph = orders.all.front().graph();
  for (const ReorderOptions& reordering : asked_for(mesh, graph, options)) {
    const Stopwatch stopwatch;
    const MeshOrder order = compute_order_in_file(mesh, graph, reordering);
    Candidate candidate{.vertices = order.vertices.method,
                        .elements = order.cells.method,
                        .workload = reordering.order.workload};
    const bool is_known = std::any_of(advice.candidates.begin(), advice.candidates.end(),
                                      [&](const Candidate& other) { return are_one(other, candidate); });
    if (is_known && (options.methods.empty() || options.race_of > 0)) continue;
    if (are_one(candidate, advice.as_is)) {
      orders.of_candidates.push_back(0);
    } else {
      orders.of_candidates.push_back(orders.all.size());
      const double seconds = options.graph_seconds + stopwatch.seconds();
      orders.all.push_back(orders.all.front().moved(order));
      candidate.order_seconds = seconds + orders.all.back().seconds_to_move();
    }
    advice.candidates.push_back(std::move(candidate));
  }
}

/// Adds the spans and patterns of all orders.
void describe(Advice& advice, const Orders& orders) {
  std::vector<Candidate> described(orders.all.size());
  take_turns(index_size(orders.all), [&](Index i) {
    const CsrGraph& graph = orders.all[i].graph();
    const Permutation as_ordered = Permutation::identity(graph.size());
    described[i].spans = quality_of(graph, as_ordered);
    described[i].pattern = pattern_of(graph, as_ordered, kPatternSide);
  });
  for_candidates(advice, orders, [&](Candidate& candidate, std::size_t order) {
    candidate.spans = described[order].spans;
    candidate.pattern = described[order].pattern;
  });
}

/// Adds the measured times of all orders.
void measure(Advice& advice, const Orders& orders, const AdviceOptions& options,
             const Stopwatch& since_call) {
  report("measure");
  const bool in_race = is_race(options);
  const Timings timings = in_race ? raced(orders.all, options) : measured(orders.all, options, since_call);
  advice.doubt = reason_to_doubt(timings.steadiness);
  if (!in_race) {
    for (double& share : advice.floor) share = std::max(share, timings.steadiness.repeat);
  }
  for_candidates(advice, orders, [&](Candidate& candidate, std::size_t order) {
    KernelMilliseconds& milliseconds = candidate.costs.measured.emplace();
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      milliseconds[k] = timings.orders[order][kKernels[k]].best_ms;
    }
  });
}

}  // namespace

double factor_for(Workload workload, const Advice& advice, std::size_t candidate) {
  return std::exp(-cost_for(workload, advice, advice.candidates[candidate].costs));
}

std::optional<std::size_t> winner_for(Workload workload, const Advice& advice) {
  double best = 0;
  double same = 0;  // Σ log(same_time) over the kernels
  int kernels = 0;
  for (const Candidate& candidate : advice.candidates) {
    best = std::min(best, cost_for(workload, advice, candidate.costs));
  }
  for (const Kernel kernel : kernels_of(advice)) {
    if (workload == Workload::all || to_string(workload) == to_string(kernel)) {
      same += std::log(same_time(advice, kernel));
      ++kernels;
    }
  }
  const double nearly_best = best + same / std::max(1, kernels);
  if (nearly_best >= 0) return std::nullopt;
  for (std::size_t i = 0;; ++i) {
    const double cost = cost_for(workload, advice, advice.candidates[i].costs);
    if (cost == best || (i == 0 && cost <= nearly_best)) return i;
  }
}

Advice advise(const Mesh& mesh, const CsrGraph& graph, const AdviceOptions& options) {
  check(options);
  const Stopwatch since_call;
  Advice advice;
  advice.threads = options.threads;
  advice.kernel_set = options.kernels;
  advice.as_is.vertices.name = advice.as_is.elements.name = "original";
  Orders orders;
  orders.all.emplace_back(mesh, graph);
  advice.is_matrix = orders.all.front().is_matrix();
  add_candidates(advice, orders, mesh, options);
  if (options.describe) describe(advice, orders);
  if (options.predict) {
    advice.machine = options.machine.in_words();
    const std::vector<KernelMilliseconds> predicted = predictions(orders.all, options);
    for_candidates(advice, orders, [&](Candidate& candidate, std::size_t order) {
      candidate.costs.predicted = predicted[order];
    });
  }
  if (options.race_of > 0) keep_best(advice, orders, options.ordering.workload, options.race_of);
  advice.floor = options.machine.floor;
  if (measures(options)) measure(advice, orders, options, since_call);
  advice.kernels = kernel_advice(advice);
  return advice;
}

std::span<const Kernel> kernels_of(const Advice& advice) {
  if (advice.is_matrix) return kProductsAlone;
  return kKernels;
}

int runs_in_time_step(const Advice& advice, std::size_t kernel) {
  return advice.is_matrix ? 1 : kRunsInTimeStep[kernel];
}

double same_time(const Advice& advice, Kernel kernel) {
  const double floor = advice.floor[static_cast<std::size_t>(kernel)];
  const bool of_this_machine = advice.as_is.costs.measured || floor > 0;
  const double of_another = kernel == Kernel::spmv ? 1.25 : 1.1;
  return std::max(of_this_machine ? 1.05 : of_another, 1 + floor);
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
  for (std::size_t k = 0; k < kernels_of(advice).size(); ++k) {
    const double as_is = advice.as_is.costs.best_known()[k];
    const double ordered = advice.candidates[candidate].costs.best_known()[k];
    const double same = same_time(advice, kKernels[k]);
    if (std::max(as_is, ordered) < same * std::min(as_is, ordered)) continue;
    saved += runs_in_time_step(advice, k) * (as_is - ordered);
  }
  return saved;
}

double steps_to_pay(const Advice& advice, std::size_t candidate) {
  const double saved = saved_in_time_step(advice, candidate);
  return saved > 0 ? std::ceil(1e3 * advice.candidates[candidate].order_seconds / saved) : 0;
}

}  // namespace meshorder
