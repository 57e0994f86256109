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

/// Returns options for short samples: many rounds give narrow intervals.
TimingOptions for_seconds(double seconds, int threads) {
  return {.budget_seconds = std::max(0.0, seconds),
          .min_rounds = 3,
          .sample_seconds = 0.004,
          .processor_time = threads == 1};
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
  return time_interleaved(pointers,
                          for_seconds(*options.measure_within - stopwatch.seconds(), options.threads));
}

/// Times the orders with the race's timer, for half a second each.
Timings raced(const std::vector<KernelInput>& orders, const AdviceOptions& options) {
  constexpr double kSeconds = 0.5;
  const auto prepare = [&](Index i) { return prepare_kernels(options.kernels, orders[i], options.threads); };
  return options.race_timer(index_size(orders), prepare,
                            for_seconds(kSeconds * static_cast<double>(orders.size()), options.threads));
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

/// Returns the ratio of two times whose error is at most a factor of `error`.
TimeRatio with_error(double as_is, double ordered, double error) {
  // a mesh of points has no work to do
  if (as_is <= 0 || ordered <= 0) return {1, 1, 1};
  const double ratio = as_is / ordered;
  return {ratio, ratio / error, ratio * error};
}

/// Keeps `most` candidates in their present sequence: the first one and the best of the others.
void keep_best(Advice& advice, Orders& orders, Workload workload, std::size_t most) {
  std::vector<std::size_t> places(advice.candidates.size());
  std::iota(places.begin(), places.end(), 0);
  if (places.size() <= most) return;
  std::stable_sort(places.begin() + 1, places.end(), [&](std::size_t a, std::size_t b) {
    return gain_for(workload, advice, a).ratio > gain_for(workload, advice, b).ratio;
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

/// Adds the spans of all orders, and their patterns if `is_whole`; else only means of spans.
void describe(Advice& advice, const Orders& orders, bool is_whole) {
  std::vector<Candidate> described(orders.all.size());
  take_turns(index_size(orders.all), [&](Index i) {
    const CsrGraph& graph = orders.all[i].graph();
    const Permutation as_ordered = Permutation::identity(graph.size());
    if (is_whole) {
      described[i].spans = quality_of(graph, as_ordered);
      described[i].pattern = pattern_of(graph, as_ordered, kPatternSide);
    } else {
      const EdgeSpan span = edge_span(graph, as_ordered);
      described[i].spans.mean_span = span.mean;
      described[i].spans.mean_log2_span = span.mean_log2;
    }
  });
  for_candidates(advice, orders, [&](Candidate& candidate, std::size_t order) {
    candidate.spans = described[order].spans;
    candidate.pattern = described[order].pattern;
  });
}

/// Adds the predicted times of all orders.
void predict(Advice& advice, const Orders& orders, const AdviceOptions& options) {
  advice.machine = options.machine.in_words();
  const std::vector<KernelMilliseconds> predicted = predictions(orders.all, options);
  for_candidates(advice, orders, [&](Candidate& candidate, std::size_t order) {
    candidate.costs.predicted = predicted[order];
  });
}

/// Adds the measured times of all orders.
void measure(Advice& advice, const Orders& orders, const AdviceOptions& options,
             const Stopwatch& since_call) {
  report("measure");
  const Timings timings =
      is_race(options) ? raced(orders.all, options) : measured(orders.all, options, since_call);
  advice.doubt = reason_to_doubt(timings.steadiness);
  for_candidates(advice, orders, [&](Candidate& candidate, std::size_t order) {
    KernelMilliseconds& milliseconds = candidate.costs.measured.emplace();
    auto& gains = candidate.costs.gains.emplace();
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      milliseconds[k] = timings.orders[order][kKernels[k]].best_ms;
      gains[k] = timings.orders[order][kKernels[k]].gain;
    }
  });
}

}  // namespace

bool is_measured(const Advice& advice) { return advice.as_is.costs.measured && advice.doubt.empty(); }

TimeRatio geometric_mean(std::span<const TimeRatio> ratios) {
  TimeRatio sums{0, 0, 0};
  for (const TimeRatio& ratio : ratios) {
    sums.ratio += std::log(ratio.ratio);
    sums.low += std::log(ratio.low);
    sums.high += std::log(ratio.high);
  }
  const auto count = static_cast<double>(ratios.size());
  return {std::exp(sums.ratio / count), std::exp(sums.low / count), std::exp(sums.high / count)};
}

TimeRatio measured_gain(const Advice& advice, const Candidate& candidate, std::size_t kernel) {
  if (!is_measured(advice)) return {};
  if (candidate.costs.gains) return (*candidate.costs.gains)[kernel];
  return with_error((*advice.as_is.costs.measured)[kernel], (*candidate.costs.measured)[kernel],
                    same_time(advice, kKernels[kernel]));
}

TimeRatio predicted_gain(const Advice& advice, const Candidate& candidate, std::size_t kernel) {
  if (!advice.as_is.costs.predicted) return {};
  return with_error((*advice.as_is.costs.predicted)[kernel], (*candidate.costs.predicted)[kernel],
                    same_time(advice, kKernels[kernel]));
}

TimeRatio gain_of(const Advice& advice, const Candidate& candidate, std::size_t kernel) {
  return is_measured(advice) ? measured_gain(advice, candidate, kernel)
                             : predicted_gain(advice, candidate, kernel);
}

TimeRatio gain_for(Workload workload, const Advice& advice, std::size_t candidate) {
  std::vector<TimeRatio> gains;
  for (std::size_t k = 0; k < kernels_of(advice).size(); ++k) {
    if (workload == Workload::all || to_string(workload) == to_string(kKernels[k]))
      gains.push_back(gain_of(advice, advice.candidates[candidate], k));
  }
  if (gains.empty()) {
    throw InvalidArgument(fmt::format("advice: no kernel measures {}", to_string(workload)));
  }
  return geometric_mean(gains);
}

std::optional<std::size_t> winner_for(Workload workload, const Advice& advice) {
  std::vector<TimeRatio> gains;
  for (std::size_t i = 0; i < advice.candidates.size(); ++i) gains.push_back(gain_for(workload, advice, i));
  const auto best = std::ranges::max_element(gains, {}, &TimeRatio::ratio);
  if (best == gains.end() || best->ratio <= 1 || !is_told_apart(*best)) return std::nullopt;
  const bool first_is_as_fast = is_told_apart(gains.front()) && gains.front().ratio >= best->low;
  return first_is_as_fast ? 0 : static_cast<std::size_t>(best - gains.begin());
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
  describe(advice, orders, options.describe);
  if (options.predict) predict(advice, orders, options);
  if (options.race_of > 0) keep_best(advice, orders, options.ordering.workload, options.race_of);
  advice.floor = options.machine.floor;
  if (measures(options)) measure(advice, orders, options, since_call);
  if (options.predict_in_doubt && !advice.doubt.empty() && !options.predict) predict(advice, orders, options);
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
  const bool of_this_machine = is_measured(advice) || floor > 0;
  const double of_another = kernel == Kernel::spmv ? 1.25 : 1.1;
  return std::max(of_this_machine ? 1.05 : of_another, 1 + floor);
}

std::array<KernelAdvice, kKernels.size()> kernel_advice(const Advice& advice) {
  std::array<KernelAdvice, kKernels.size()> result;
  for (std::size_t k = 0; k < kernels_of(advice).size(); ++k) {
    KernelAdvice& of_kernel = result[k];
    for (std::size_t i = 0; i < advice.candidates.size(); ++i) {
      const TimeRatio gain = gain_of(advice, advice.candidates[i], k);
      if (gain.ratio <= of_kernel.gain.ratio || !is_told_apart(gain)) continue;
      of_kernel = {i, gain, std::ceil(1e3 * advice.candidates[i].order_seconds / saved_ms(advice, i, k))};
    }
  }
  return result;
}

double saved_ms(const Advice& advice, std::size_t candidate, std::size_t kernel) {
  const TimeRatio gain = gain_of(advice, advice.candidates[candidate], kernel);
  return is_told_apart(gain) ? known_ms(advice, kernel) * (1 - 1 / gain.ratio) : 0;
}

double known_ms(const Advice& advice, std::size_t kernel) {
  const OrderCosts& costs = advice.as_is.costs;
  return is_measured(advice) || !costs.predicted ? (*costs.measured)[kernel] : (*costs.predicted)[kernel];
}

double steps_to_pay(const Advice& advice, std::size_t candidate) {
  double saved = 0;
  for (std::size_t k = 0; k < kernels_of(advice).size(); ++k)
    saved += runs_in_time_step(advice, k) * saved_ms(advice, candidate, k);
  return saved > 0 ? std::ceil(1e3 * advice.candidates[candidate].order_seconds / saved) : 0;
}

}  // namespace meshorder
