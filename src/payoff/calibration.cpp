// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/calibration.hpp"

#include "base/host.hpp"
#include "base/median.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "base/stopwatch.hpp"
#include "mesh/graphs.hpp"
#include "mesh/simplices.hpp"
#include "payoff/calibration_lattices.hpp"
#include "payoff/kernel_bench.hpp"
#include "payoff/kernel_timing.hpp"
#include "payoff/least_squares.hpp"
#include "payoff/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Times of the kernels on a number of threads, by kernel.
struct Runs {
  int threads = 1;
  std::array<std::vector<TimedReuse>, kKernels.size()> timed = {};
  /// Relative differences of two timings of the same problem.
  std::array<std::vector<double>, kKernels.size()> apart = {};
  std::vector<Steadiness> steadiness = {};  ///< steadiness of each measurement
};

/// Returns the `halvings` for a lattice: 0 for a small lattice; above 0, the reuse is estimated.
int halvings_for_lattice(SimplicesRef simplices) { return simplices.size() < 50'000 ? 0 : 3; }

/// Limits on the timing of orders.
struct Rounds {
  double seconds = 0;
  int least = 3;  ///< least number of rounds, however long they take
};

/// Orders of a lattice, prepared to be timed.
struct Prepared {
  std::vector<LatticeOrder> orders;
  std::vector<CsrGraph> graphs;
  std::vector<Simplices> simplices;
  std::vector<KernelReuse> reuse;
  std::vector<std::unique_ptr<KernelBench>> benches;

  Prepared(const CalibrationLattice& lattice, std::span<const LatticeOrder> some) { add(lattice, some); }

  /// Adds orders: moves the lattice into each, simulates the reuse and prepares the kernels, on all threads.
  void add(const CalibrationLattice& lattice, std::span<const LatticeOrder> some) {
    const std::size_t first = benches.size();
    orders.insert(orders.end(), some.begin(), some.end());
    graphs.resize(orders.size());
    simplices.resize(orders.size());
    reuse.resize(orders.size());
    benches.resize(orders.size());
    std::vector<Mesh> meshes(some.size());
    take_turns(index_size(some), [&](Index turn) {
      const std::size_t i = first + static_cast<std::size_t>(turn);
      meshes[turn] = in_order(lattice, orders[i]);
      graphs[i] = vertex_graph(meshes[turn]);
      simplices[i] = cut_into_simplices(meshes[turn]);
    });
    // an order that is timed twice is simulated once
    const auto place_of = [&](std::size_t i) {
      return static_cast<std::size_t>(
          std::find(orders.begin() + static_cast<std::ptrdiff_t>(first), orders.end(), orders[i]) -
          orders.begin());
    };
    take_turns(index_size(some) * (1 + index_size(kKernels)), [&](Index turn) {
      const Index order = turn % index_size(some);
      const Index task = turn / index_size(some);
      const std::size_t i = first + static_cast<std::size_t>(order);
      if (task == 0) {
        benches[i] = prepare_kernels(KernelSet::plain, meshes[order], graphs[i]);
      } else if (place_of(i) == i) {
        const std::size_t k = kLongestFirst[task - 1];
        reuse[i][k] = reuse_of(kKernels[k], graphs[i], simplices[i], halvings_for_lattice(simplices[i]));
      }
    });
    for (std::size_t i = first; i < orders.size(); ++i) reuse[i] = reuse[place_of(i)];
  }

  /// Lets `threads` threads share each later run of the kernels.
  void share(int threads) {
    for_each_chunk(index_size(benches), 1,
                   [&](Index i, Index /*begin*/, Index /*end*/) { benches[i]->share(threads); });
  }

  /// Times all orders in interleaved rounds: on one thread by its processor time, on several threads by
  /// elapsed time.
  [[nodiscard]] Timings timed(int threads, const Rounds& rounds) {
    std::vector<KernelBench*> pointers;
    for (const auto& bench : benches) pointers.push_back(bench.get());
    return time_interleaved(pointers, {.budget_seconds = rounds.seconds,
                                       .min_rounds = rounds.least,
                                       .max_rounds = 40,
                                       .sample_seconds = 0.003,
                                       .processor_time = threads == 1});
  }
};

/// Times all orders of a lattice in interleaved rounds, on the threads of `runs`, and adds the times to
/// `runs`.
Timings time_all(Prepared& prepared, int lattice, const Rounds& rounds, Runs& runs) {
  if (runs.threads > 1) prepared.share(runs.threads);
  Timings timings = prepared.timed(runs.threads, rounds);
  for (std::size_t i = 0; i < prepared.reuse.size(); ++i) {
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      const double times =
          times_computed(kKernels[k], prepared.graphs[i], prepared.simplices[i], runs.threads);
      runs.timed[k].push_back(
          {prepared.reuse[i][k], timings.orders[i][kKernels[k]].best_ms / times, lattice});
    }
  }
  runs.steadiness.push_back(timings.steadiness);
  return timings;
}

/// Returns the steadiness of several measurements: the worst disturbances, but the median of the repeat
/// differences, since a short measurement repeats less well than a long one.
Steadiness steadiness_of(std::span<const Steadiness> measurements) {
  Steadiness result;
  std::vector<double> repeats;
  for (const Steadiness& one : measurements) {
    result.waiting = std::max(result.waiting, one.waiting);
    result.pace = std::max(result.pace, one.pace);
    repeats.push_back(one.repeat);
  }
  result.repeat = median(std::move(repeats));
  return result;
}

/// Two sizes that differ by less than this factor count as the same cache.
constexpr double kSameCache = 1.6;

/// Returns the caches that costs belong to. A found cache within a factor of `kSameCache` of a reported cache
/// gets the reported size. The last found cache never gets the last reported size: a thread shares that cache
/// with others.
Caches effective_caches(const FoundCaches& found, const Caches& reported) {
  Caches caches;
  for (std::size_t i = 0; i < found.levels.size(); ++i) {
    Offset bytes = found.levels[i].bytes / kLineBytes * kLineBytes;
    for (const Offset level : reported.level_bytes) {
      const double ratio = static_cast<double>(level) / static_cast<double>(bytes);
      const bool shared = i + 1 == found.levels.size() && level == reported.level_bytes.back();
      if (!shared && ratio < kSameCache && ratio > 1 / kSameCache) bytes = level;
    }
    if (caches.level_bytes.empty() || bytes > caches.level_bytes.back()) caches.level_bytes.push_back(bytes);
  }
  return caches;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  (void)gmtime_r(&now, &parts);
  return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

/// Measures the caches, the latencies and the read bandwidths.
void measure_memory(const CalibrationEffort& effort, Calibration& calibration) {
  // a small machine must not swap
  const auto most = static_cast<Offset>(std::min<std::uint64_t>(usable_memory() / 8, UINT64_C(1) << 40));
  const std::vector<Offset> sizes = probe_sizes(std::min(effort.probed, most));
  constexpr int kRounds = 8;
  calibration.found =
      find_caches(probe_latencies(sizes, kRounds, [](double share) { report("caches", 0.2 * share); }));
  report("bandwidths", 0.2);
  const auto bytes = static_cast<std::size_t>(std::min(effort.probed, most));
  constexpr int kPasses = 4;
  calibration.read_bandwidth = read_bandwidth(bytes, kPasses);
  calibration.threads = thread_count();
  calibration.read_bandwidth_all = calibration.threads > 1
                                       ? read_bandwidth(bytes, kPasses, calibration.threads)
                                       : calibration.read_bandwidth;
}

/// Times all orders of a lattice in the same rounds. Times the last order but one twice, at different
/// addresses.
void time_small(const CalibrationLattice& lattice, int number, double seconds, std::span<Runs> runs) {
  const std::size_t twice = lattice.orders.size() - 2;
  std::vector<LatticeOrder> orders = lattice.orders;
  orders.push_back(orders[twice]);
  Prepared prepared(lattice, orders);
  for (Runs& some : runs) {
    const Timings timings =
        time_all(prepared, number,
                 some.threads == 1 ? Rounds{seconds} : Rounds{.seconds = seconds / 4, .least = 2}, some);
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      const double one = timings.orders[twice][kKernels[k]].best_ms;
      const double other = timings.orders.back()[kKernels[k]].best_ms;
      some.apart[k].push_back(std::max(one, other) / std::min(one, other) - 1);
    }
  }
}

/// Times the best and the worst order of a lattice, then others while the next should end before the
/// stopwatch shows `seconds`. Times the best and the worst on all threads as well.
void time_large(CalibrationLattice lattice, int number, const Stopwatch& since_start, double seconds,
                std::span<Runs> runs) {
  std::vector<LatticeOrder>& orders = lattice.orders;
  // the worst order comes second, as it decides the predictions for meshes larger than all lattices
  std::swap(orders[1], orders.back());
  double longest = 0;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const double begin = since_start.seconds();
    if (i >= 2 && begin + longest > seconds) break;
    report("lattices", std::min(0.98, 0.6 + 0.4 * (begin / seconds - 0.5)));
    Prepared prepared(lattice, std::span(orders).subspan(i, 1));
    for (Runs& some : runs.first(i < 2 ? runs.size() : 1))
      (void)time_all(prepared, number, {.seconds = 0.3, .least = 2}, some);
    longest = std::max(longest, since_start.seconds() - begin);
  }
}

/// Returns for each run a row: its counts, at 1 ns a count, as shares of the run's time.
Rows shares_of(std::span<const TimedReuse> runs, const Caches& caches) {
  const std::array<Offset, 4> sizes = sizes_that_cost(caches);
  Rows rows{.columns = CostRow{}.size()};
  for (const TimedReuse& run : runs) {
    CostRow row = counts_of(run.reuse, sizes);
    for (double& count : row) count *= 1e-6 / run.milliseconds;
    rows.push_back(row);
  }
  return rows;
}

/// Multiplies the mean row of each lattice's runs by a factor; each row keeps its difference from the mean.
void scale_means(double factor, std::span<const TimedReuse> runs, Rows& rows) {
  struct Mean {
    std::vector<double> row;
    double runs = 0;
  };
  std::map<int, Mean> means;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Mean& mean = means[runs[i].lattice];
    mean.row.resize(rows.columns);
    std::transform(mean.row.begin(), mean.row.end(), rows[i].begin(), mean.row.begin(), std::plus<>());
    ++mean.runs;
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Mean& mean = means[runs[i].lattice];
    for (std::size_t j = 0; j < rows.columns; ++j)
      rows.values[i * rows.columns + j] -= (1 - factor) * mean.row[j] / mean.runs;
  }
}

/// Returns predicted time / measured time of each run.
std::vector<double> predicted_shares(const Rows& rows, const CostRow& costs) {
  std::vector<double> predicted;
  for (std::size_t i = 0; i < rows.size(); ++i)
    predicted.push_back(std::inner_product(costs.begin(), costs.end(), rows[i].begin(), 0.0));
  return predicted;
}

double median_error(std::vector<double> predicted) {
  for (double& share : predicted) share = std::abs(share - 1);
  return median(std::move(predicted));
}

std::vector<TimedReuse> of_solids(std::span<const TimedReuse> runs) {
  std::vector<TimedReuse> result;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(result),
               [](const TimedReuse& run) { return run.reuse.dimension == 3; });
  return result;
}

/// Fits the costs of all kernels to the runs and stores them in `model`, whose caches must be set; `like` as
/// in fit_costs. Returns the quality of the fit.
FitQuality fit_all(const Runs& runs, const Latencies& latencies, CostModel& model,
                   const CostModel* like = nullptr) {
  FitQuality quality;
  model.threads = runs.threads;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    const FittedCosts fitted = fit_costs(of_solids(runs.timed[k]), model.caches, latencies,
                                         like != nullptr ? &like->solid[k] : nullptr);
    model.solid[k] = fitted.costs;
    model.flat[k] =
        fit_costs(runs.timed[k], model.caches, latencies, like != nullptr ? &like->flat[k] : nullptr).costs;
    quality.condition[k] = fitted.condition;
    quality.error[k] = fitted.error;
    quality.floor[k] = median(runs.apart[k]);
  }
  return quality;
}

/// Like `fit_all`, for runs on all threads, given the costs on one thread. The costs of products with a
/// matrix are the costs on one thread times one factor: threads that share a product never wait for each
/// other, and the few runs determine one factor better than ten costs.
FitQuality fit_all_threads(const Runs& runs, const Latencies& latencies, const CostModel& one_thread,
                           CostModel& model) {
  FitQuality quality = fit_all(runs, latencies, model, &one_thread);
  constexpr auto kProduct = static_cast<std::size_t>(Kernel::spmv);
  const FittedCosts fitted =
      scale_costs(of_solids(runs.timed[kProduct]), one_thread.solid[kProduct], model.caches);
  model.solid[kProduct] = fitted.costs;
  model.flat[kProduct] = scale_costs(runs.timed[kProduct], one_thread.flat[kProduct], model.caches).costs;
  quality.condition[kProduct] = fitted.condition;
  quality.error[kProduct] = fitted.error;
  return quality;
}

}  // namespace

Latencies latencies_beyond(const FoundCaches& found, const Caches& caches) {
  const auto latency_behind = [&](Offset bytes) {
    for (const FoundCache& level : found.levels) {
      if (static_cast<double>(level.bytes) > kSameCache * static_cast<double>(bytes))
        return level.nanoseconds;
    }
    return found.memory_nanoseconds;
  };
  const std::array<Offset, 4> sizes = sizes_that_cost(caches);
  const double first = latency_behind(sizes[0]);
  const double second = latency_behind(sizes[1]);
  const double rest = (found.memory_nanoseconds - second) / 2;
  // a difference too small to measure does not make jumps free
  constexpr double kLeast = 1;
  return {std::max(kLeast, first - found.levels.front().nanoseconds), std::max(kLeast, second - first),
          std::max(kLeast, rest), std::max(kLeast, rest)};
}

FittedCosts fit_costs(std::span<const TimedReuse> runs, const Caches& caches, const Latencies& latencies,
                      const KernelCosts* like) {
  const Rows shares = shares_of(runs, caches);
  // Besides the costs there are two unknowns. The first is the cost of a jump as a share of its latency, in
  // units of kShare. An equation for each jump cost, with an eightieth of the weight of a run, sets the cost
  // to that share of the latency.
  constexpr double kShare = 0.1;
  constexpr double kWeight = 0.0125;
  // The weight of the error that all runs of a lattice have in common.
  constexpr double kCommon = 0.5;
  // The second unknown is the ratio of all costs to the costs of `like`. An equation for each cost, of this
  // weight, sets the cost to that multiple.
  constexpr double kLike = 0.4;
  Rows rows{.columns = shares.columns + 2};
  std::vector<double> row(rows.columns);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    std::copy(shares[i].begin(), shares[i].end(), row.begin());
    rows.push_back(row);
  }
  scale_means(kCommon, runs, rows);
  std::vector<double> right(runs.size(), kCommon);
  for (std::size_t i = 0; i < latencies.size(); ++i) {
    KernelCosts one;
    one.jump[i] = kWeight / (kShare * latencies[i]);
    const CostRow of_jump = as_row(one);
    std::copy(of_jump.begin(), of_jump.end(), row.begin());
    row[shares.columns] = -kWeight;
    rows.push_back(row);
    right.push_back(0);
  }
  const CostRow known = like != nullptr ? as_row(*like) : CostRow{};
  for (std::size_t j = 0; like != nullptr && j < known.size(); ++j) {
    std::fill(row.begin(), row.end(), 0.0);
    if (known[j] > 0) {
      row[j] = kLike / known[j];
      row.back() = -kLike;
    } else {
      // a cost that is 0 in `like` stays near 0; its weight is its mean share of the times
      for (std::size_t i = 0; i < shares.size(); ++i)
        row[j] += shares[i][j] / static_cast<double>(shares.size());
    }
    rows.push_back(row);
    right.push_back(0);
  }
  const std::vector<double> costs = non_negative_least_squares(rows, right);
  CostRow found;
  std::copy_n(costs.begin(), found.size(), found.begin());
  return {.costs = as_costs(found),
          .condition = condition_number(rows),
          .error = median_error(predicted_shares(shares, found))};
}

FittedCosts scale_costs(std::span<const TimedReuse> runs, const KernelCosts& costs, const Caches& caches) {
  std::vector<double> predicted = predicted_shares(shares_of(runs, caches), as_row(costs));
  const double factor = std::accumulate(predicted.begin(), predicted.end(), 0.0) /
                        std::inner_product(predicted.begin(), predicted.end(), predicted.begin(), 0.0);
  CostRow row = as_row(costs);
  for (double& cost : row) cost *= factor;
  for (double& share : predicted) share *= factor;
  return {.costs = as_costs(row), .condition = 1, .error = median_error(std::move(predicted))};
}

CalibrationEffort effort_of(double seconds) {
  CalibrationEffort effort;
  const double share = std::min(1.0, seconds / (0.5 * effort.seconds));
  effort.seconds = seconds;
  constexpr Offset kLeastProbed = Offset{8} << 20;
  constexpr Index kLeastVertices = 4000;
  effort.probed = std::max(kLeastProbed, static_cast<Offset>(share * static_cast<double>(effort.probed)));
  effort.vertices = std::max(kLeastVertices, static_cast<Index>(share * effort.vertices));
  return effort;
}

Calibration measure_machine(const CalibrationEffort& effort) {
  const Stopwatch since_start;
  Calibration calibration;
  calibration.processor = processor_of_this_machine();
  calibration.build = build_of_this_program();
  calibration.date = today();
  calibration.reported = reported_caches();
  report("caches", 0);
  measure_memory(effort, calibration);
  CostModel& model = calibration.model;
  model.caches = effective_caches(calibration.found, calibration.reported);
  model.machine = fmt::format("{} ({})", calibration.processor, to_string(model.caches));

  std::vector<Runs> runs(1);
  if (calibration.threads > 1) runs.push_back({.threads = calibration.threads});
  constexpr Offset kBytesOfVertex = 4096;
  const Offset fitting = static_cast<Offset>(usable_memory() / 4) / kBytesOfVertex;
  const auto largest = static_cast<Index>(std::clamp<Offset>(fitting, 1000, effort.vertices));
  // Returns the number of rows of a matrix that fills a part of the second or last cache, so that its streams
  // miss one cache and hit the next.
  constexpr Offset kRowBytes = 180;
  const auto rows_in = [&](Offset bytes, double part) {
    const auto rows = static_cast<Offset>(part * static_cast<double>(bytes) / kRowBytes);
    return static_cast<Index>(std::clamp<Offset>(rows, 300, std::max<Offset>(300, largest / 4)));
  };
  const std::array<Offset, 4> sizes = sizes_that_cost(model.caches);
  /// A lattice, and its share of the time. Some lattices are also timed on all threads; the smallest is not,
  /// because waking the threads takes as long as a run on it. A lattice with `streams` has a matrix that
  /// streams from memory, and one more order, in which the rows of a window fill the second cache twice. As
  /// in a Fiedler order, data to be gathered has left the first cache, and data to be added to has left the
  /// second.
  struct Step {
    Index vertices;
    bool flat;
    std::size_t orders;
    double share;
    bool on_all_threads;
    bool streams = false;
  };
  const std::array steps{Step{rows_in(sizes[1], 0.6), false, 3, 0.02, false},
                         Step{rows_in(sizes[3], 0.35), false, 5, 0.03, true},
                         Step{rows_in(sizes[3], 0.75), false, 3, 0.02, false},
                         Step{largest / 8, false, 6, 0.08, true},
                         Step{largest / 8, true, 4, 0.03, true},
                         Step{largest / 3, false, 3, 0.06, true, true}};
  double done = 0.25;
  int number = 0;
  for (const Step& step : steps) {
    report("lattices", done);
    CalibrationLattice lattice =
        make_calibration_lattice(step.vertices, step.flat, model.caches, step.orders);
    if (step.streams) lattice.orders.insert(lattice.orders.begin() + 2, {rows_in(sizes[1], 2)});
    time_small(lattice, number++, step.share * effort.seconds,
               std::span(runs).first(step.on_all_threads ? runs.size() : 1));
    done += step.share;
  }
  time_large(make_calibration_lattice(largest, false, model.caches, 6), number, since_start, effort.seconds,
             runs);
  calibration.steadiness = steadiness_of(runs.front().steadiness);
  calibration.all_threads = model;
  const Latencies latencies = latencies_beyond(calibration.found, model.caches);
  calibration.quality = fit_all(runs.front(), latencies, model);
  calibration.all_threads_quality =
      calibration.threads > 1 ? fit_all_threads(runs.back(), latencies, model, calibration.all_threads)
                              : fit_all(runs.back(), latencies, calibration.all_threads);
  calibration.seconds = since_start.seconds();
  return calibration;
}

Recheck recheck(const Calibration& calibration) {
  const Caches& caches = calibration.model.caches;
  const auto ends = [](const CalibrationLattice& lattice) {
    return std::array{lattice.orders.front(), lattice.orders[lattice.orders.size() - 2]};
  };
  report("recheck", 0);
  const CalibrationLattice small = make_calibration_lattice(4000, false, caches, 3);
  Prepared prepared(small, ends(small));
  report("recheck", 0.2);
  const CalibrationLattice large = make_calibration_lattice(30'000, false, caches, 3);
  prepared.add(large, ends(large));
  report("recheck", 0.5);
  const Timings timings = prepared.timed(1, {.seconds = 1});
  Recheck result;
  std::vector<std::string> moved;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < prepared.reuse.size(); ++i) {
      const double predicted = predicted_ms(prepared.reuse[i][k], caches, calibration.model);
      ratios.push_back(timings.orders[i][kKernels[k]].best_ms / std::max(predicted, 1e-9));
    }
    result.ratio[k] = median(std::move(ratios));
    const double most = std::max(0.15, 3 * (calibration.quality.error[k] + calibration.quality.floor[k]));
    if (std::abs(std::log(result.ratio[k])) <= std::log(1 + most)) continue;
    moved.push_back(
        fmt::format("{} takes {:.2f} times as long as it did", kKernelTitles[k], result.ratio[k]));
  }
  if (!moved.empty()) {
    result.moved = "this machine has changed since it was calibrated (" + join(moved) +
                   "); `meshorder calibrate` measures it again";
  }
  result.doubt = reason_to_doubt(timings.steadiness);
  return result;
}

}  // namespace meshorder
