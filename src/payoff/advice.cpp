// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/advice.hpp"

#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "base/stopwatch.hpp"
#include "mesh/reorder.hpp"
#include "mesh/simplices.hpp"
#include "mesh/stored_matrix.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/sparsity_pattern.hpp"
#include "ordering/auto.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/cost_model.hpp"
#include "payoff/shared_work.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// A mesh in the order of a candidate.
struct Moved {
  Mesh mesh;  ///< points and cells, for kernels to be timed; none where times are only predicted
  CsrGraph graph;
  CellSimplices simplices;
  EntryPattern pattern;  ///< of a matrix, where times are predicted
};

/// A mesh in one of the orders.
struct Ordered {
  const Mesh* mesh = nullptr;
  const CsrGraph* graph = nullptr;
  const CellSimplices* simplices = nullptr;
  const EntryPattern* pattern = nullptr;    ///< null if the mesh is no matrix
  std::unique_ptr<const Moved> moved = {};  ///< owns what the pointers refer to; null: the mesh as it is
};

Ordered ordered(std::unique_ptr<const Moved> moved, bool is_matrix) {
  return {&moved->mesh, &moved->graph, &moved->simplices, is_matrix ? &moved->pattern : nullptr,
          std::move(moved)};
}

RunReuse reuse_in(const Ordered& order, Kernel kernel, int halvings) {
  return order.pattern != nullptr ? reuse_of_product(*order.pattern, halvings)
                                  : reuse_of(kernel, *order.graph, *order.simplices, halvings);
}

/// Returns the predictions for all orders. Threads take the pairs of a kernel and an order in turns.
std::vector<KernelMilliseconds> predictions(const std::vector<Ordered>& orders,
                                            const AdviceOptions& options) {
  report("predict");
  const Caches& caches = options.caches.level_bytes.empty() ? options.machine.model.caches : options.caches;
  const int halvings = options.halvings.value_or(halvings_for(orders.front().simplices->size()));
  const bool is_matrix = orders.front().pattern != nullptr;
  std::vector<KernelMilliseconds> result(orders.size());
  take_turns((is_matrix ? 1 : index_size(kKernels)) * index_size(orders), [&](Index turn) {
    const Index i = turn % index_size(orders);
    const std::size_t k = is_matrix ? 0 : kLongestFirst[turn / index_size(orders)];
    const RunReuse reuse = i == 0 && options.reuse_as_is ? (*options.reuse_as_is)[k]
                                                         : reuse_in(orders[i], kKernels[k], halvings);
    result[i][k] = predicted_ms(reuse, caches, options.machine.model) *
                   times_computed(kKernels[k], *orders[i].graph, *orders[i].simplices, options.threads);
  });
  return result;
}

TimingOptions for_seconds(double seconds) {
  return {.budget_seconds = std::max(0.0, seconds), .min_rounds = 2, .sample_seconds = 0.01};
}

/// Times all orders together, in rounds that end within `options.measure_within` seconds on the stopwatch.
Timings measured(const std::vector<Ordered>& orders, const AdviceOptions& options,
                 const Stopwatch& stopwatch) {
  std::vector<std::unique_ptr<KernelBench>> benches(orders.size());
  for_each_chunk(index_size(orders), 1, [&](Index i, Index /*begin*/, Index /*end*/) {
    benches[i] = prepare_kernels(options.kernels, *orders[i].mesh, *orders[i].graph, options.threads);
  });
  std::vector<KernelBench*> pointers;
  pointers.reserve(benches.size());
  for (const auto& bench : benches) pointers.push_back(bench.get());
  return time_interleaved(pointers, for_seconds(*options.measure_within - stopwatch.seconds()));
}

/// Times the orders with the race's timer, for half a second each.
Timings raced(const std::vector<Ordered>& orders, const AdviceOptions& options) {
  constexpr double kSeconds = 0.5;
  const auto prepare = [&](Index i) {
    return prepare_kernels(options.kernels, *orders[i].mesh, *orders[i].graph, options.threads);
  };
  return options.race_timer(index_size(orders), prepare,
                            for_seconds(kSeconds * static_cast<double>(orders.size())));
}

/// Returns the options of the orders to compute. Without `options.methods` these are `auto` for all kernels
/// and, where `auto` chooses another method for springs, `auto` for springs.
std::vector<ReorderOptions> asked_for(const Mesh& mesh, const CsrGraph& graph, const AdviceOptions& options) {
  std::vector<ReorderOptions> result;
  for (const MeshMethods& methods : options.methods) {
    result.push_back({.methods = methods, .order = options.ordering});
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

/// Returns whether two candidates have the same methods, so that they are the same order.
bool are_one(const Candidate& a, const Candidate& b) {
  return a.vertices.name == b.vertices.name && a.elements.name == b.elements.name;
}

/// Returns the logarithm of the time in an order divided by the time in the mesh's own order, averaged over
/// the kernels of a workload. Throws InvalidArgument if it has none.
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
    throw InvalidArgument(fmt::format("advice: no kernel tells what is best for {}", to_string(workload)));
  }
  return sum / kernels;
}

/// Keeps the first candidate and the best others, `most` in all, without changing their sequence.
/// `order_of[i]` is the place in `orders` of the order of candidate i.
void keep_best(Advice& advice, std::vector<Ordered>& orders, std::vector<std::size_t>& order_of,
               Workload workload, std::size_t most) {
  std::vector<std::size_t> places(advice.candidates.size());
  std::iota(places.begin(), places.end(), 0);
  if (places.size() <= most) return;
  std::stable_sort(places.begin() + 1, places.end(), [&](std::size_t a, std::size_t b) {
    return cost_for(workload, advice, advice.candidates[a].costs) <
           cost_for(workload, advice, advice.candidates[b].costs);
  });
  places.resize(most);
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == i) continue;
    advice.candidates[i] = std::move(advice.candidates[places[i]]);
    order_of[i] = order_of[places[i]];
  }
  advice.candidates.resize(most);
  order_of.resize(most);
  std::vector<Ordered> kept;
  kept.push_back(std::move(orders.front()));
  for (std::size_t& place : order_of) {
    if (place == 0) continue;
    kept.push_back(std::move(orders[place]));
    place = kept.size() - 1;
  }
  orders = std::move(kept);
}

}  // namespace

double factor_for(Workload workload, const Advice& advice, std::size_t candidate) {
  return std::exp(-cost_for(workload, advice, advice.candidates[candidate].costs));
}

std::optional<std::size_t> winner_for(Workload workload, const Advice& advice) {
  double best = 0;
  double same = 0;  // sum over the kernels of the logarithms of same_time
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
  const Stopwatch since_call;
  Advice advice;
  advice.threads = options.threads;
  advice.kernel_set = options.kernels;
  advice.is_matrix = stored_matrix(mesh) != nullptr;
  advice.as_is.vertices.name = advice.as_is.elements.name = "original";
  const CellSimplices simplices(mesh);
  std::vector<Ordered> orders(1);
  const EntryPattern pattern = advice.is_matrix && options.predict ? entry_pattern(mesh) : EntryPattern{};
  orders.front() = {&mesh, &graph, &simplices, advice.is_matrix ? &pattern : nullptr};
  const bool in_race = options.race_of > 0 && options.race_timer;
  const bool measures = in_race || options.measure_within;
  // the place in `orders` of each candidate's order; 0, the mesh as it is, if it moves nothing
  std::vector<std::size_t> order_of;
  for (const ReorderOptions& reordering : asked_for(mesh, graph, options)) {
    const Stopwatch stopwatch;
    const MeshOrder order = compute_reordering(mesh, graph, reordering);
    Candidate candidate{.vertices = order.vertices.method,
                        .elements = order.cells.method,
                        .workload = reordering.order.workload};
    const bool moves_nothing = are_one(candidate, advice.as_is);
    const bool is_known = std::any_of(advice.candidates.begin(), advice.candidates.end(),
                                      [&](const Candidate& other) { return are_one(other, candidate); });
    if (is_known && (options.methods.empty() || options.race_of > 0)) continue;
    order_of.push_back(moves_nothing ? 0 : orders.size());
    if (!moves_nothing) {
      auto moved = std::make_unique<Moved>();
      if (measures) {
        moved->mesh.points = mesh.points;
        moved->mesh.cells = mesh.cells;
        moved->mesh.format_metadata = mesh.format_metadata;
        apply_reordering(moved->mesh, order);
        moved->simplices = CellSimplices(moved->mesh);
      } else {
        moved->simplices = simplices.moved(order.vertices.permutation, order.cells.permutation);
      }
      candidate.order_seconds = options.graph_seconds + stopwatch.seconds();
      moved->graph = renumbered(graph, order.vertices.permutation.old_to_new());
      if (advice.is_matrix && options.predict)
        moved->pattern = meshorder::moved(order.vertices.permutation, pattern);
      orders.push_back(ordered(std::move(moved), advice.is_matrix));
    }
    advice.candidates.push_back(std::move(candidate));
  }
  // calls `call(candidate, place of its order)` for the mesh as it is and for each candidate
  const auto for_candidates = [&](auto call) {
    call(advice.as_is, std::size_t{0});
    for (std::size_t i = 0; i < order_of.size(); ++i) call(advice.candidates[i], order_of[i]);
  };
  if (options.describe) {
    std::vector<Candidate> described(orders.size());
    take_turns(index_size(orders), [&](Index i) {
      const Permutation as_ordered = Permutation::identity(orders[i].graph->size());
      described[i].spans = quality_of(*orders[i].graph, as_ordered);
      described[i].pattern = pattern_of(*orders[i].graph, as_ordered, kPatternSide);
    });
    for_candidates([&](Candidate& candidate, std::size_t order) {
      candidate.spans = described[order].spans;
      candidate.pattern = described[order].pattern;
    });
  }
  if (options.predict) {
    advice.machine = options.machine.in_words();
    const std::vector<KernelMilliseconds> predicted = predictions(orders, options);
    for_candidates(
        [&](Candidate& candidate, std::size_t order) { candidate.costs.predicted = predicted[order]; });
  }
  if (options.race_of > 0) keep_best(advice, orders, order_of, options.ordering.workload, options.race_of);
  advice.floor = options.machine.floor;
  if (measures) {
    report("measure");
    const Timings timings = in_race ? raced(orders, options) : measured(orders, options, since_call);
    advice.doubt = reason_to_doubt(timings.steadiness);
    if (!in_race) {
      for (double& share : advice.floor) share = std::max(share, timings.steadiness.repeat);
    }
    for_candidates([&](Candidate& candidate, std::size_t order) {
      KernelMilliseconds& milliseconds = candidate.costs.measured.emplace();
      for (std::size_t k = 0; k < kKernels.size(); ++k) {
        milliseconds[k] = timings.orders[order][kKernels[k]].best_ms;
      }
    });
  }
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
