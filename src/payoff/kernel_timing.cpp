// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/kernel_timing.hpp"

#include "base/median.hpp"
#include "base/memory.hpp"
#include "base/run_scope.hpp"
#include "base/stopwatch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace meshorder {
namespace {

/// The samples of a kernel in an order.
struct KernelSamples {
  std::vector<double> seconds;  ///< of a run
  double share = 1;             ///< see KernelTimes
};

/// The samples of an order, by kernel.
using Samples = std::array<KernelSamples, kKernels.size()>;

KernelSamples& of(Samples& samples, Kernel kernel) { return samples[static_cast<std::size_t>(kernel)]; }

/// Seconds of some runs.
struct RunTime {
  double elapsed = 0;
  double on_thread = 0;  ///< processor time of this thread

  [[nodiscard]] double by(const TimingOptions& options) const {
    return options.processor_time ? on_thread : elapsed;
  }
};

template <class Runs>
RunTime time_of(const Runs& runs) {
  const ThreadStopwatch thread;
  const Stopwatch stopwatch;
  runs();
  return {stopwatch.seconds(), thread.seconds()};
}

/// How samples of a kernel are taken.
struct Plan {
  int repeats = 1;   ///< 0: no samples are taken
  int warm_ups = 0;  ///< number of runs before the sample, which are not timed
  /// Duration of the fastest run so far.
  double seconds = std::numeric_limits<double>::infinity();
  double share = 1;  ///< share of the elements that the run covered; see KernelTimes
  std::optional<RunTime> of_first_round = {};  ///< sample of the first round, if it is taken already

  [[nodiscard]] bool has_run() const { return !std::isinf(seconds); }
};

/// Takes a sample; returns the time of all its runs.
RunTime sample(KernelBench& bench, Kernel kernel, const Plan& plan) {
  for (int i = 0; i < plan.warm_ups; ++i) bench.run(kernel);
  return time_of([&] {
    for (int i = 0; i < plan.repeats; ++i) bench.run(kernel);
  });
}

/// Returns a plan with the time of a whole run, computed from a run in stretches; empty if there is none.
Plan plan_by_stretches(KernelBench& bench, Kernel kernel, const TimingOptions& options) {
  Plan plan;
  double share = 0;
  const RunTime time = time_of([&] { share = bench.run_stretches(kernel); });
  if (share > 0) plan = {.seconds = time.by(options) / share, .share = share};
  return plan;
}

/// Plans the samples of a kernel by a few runs. `is_first`: the kernel has not run yet.
Plan plan_samples(KernelBench& bench, Kernel kernel, bool is_first, const TimingOptions& options) {
  constexpr double kMostRepeats = 1e5;
  constexpr std::size_t kMostRuns = 12;
  // a kernel that runs longer than kLong · sample_seconds reads far more than the caches hold, so it needs no
  // warm-up; for a first run the limit is twice as long, because first runs take longer
  constexpr double kLong = 5.0;
  const double least = options.sample_seconds;
  Plan plan;
  std::vector<double> seconds;
  double best = std::numeric_limits<double>::infinity();
  RunTime time;
  while (seconds.empty() || (is_first && seconds.size() < 2 && best < 2 * kLong * least) ||
         (best < kLong * least && seconds.size() < kMostRuns && !is_steady(seconds))) {
    time = time_of([&] { bench.run(kernel); });
    seconds.push_back(std::max(time.elapsed, 1e-9));
    best = std::min(best, seconds.back());
    plan.seconds = std::min(plan.seconds, time.by(options));
  }
  if (best < kLong * least) {
    plan.repeats = static_cast<int>(std::clamp(std::ceil(least / best), 1.0, kMostRepeats));
    plan.warm_ups = runs_to_settle(seconds);
  } else {
    plan.of_first_round = time;
  }
  return plan;
}

/// The plans of each order, by kernel.
using Plans = std::vector<std::array<Plan, kKernels.size()>>;

/// Ends the timing of plainly slow orders: the run that made the plan becomes their only sample. Runs in such
/// an order are long and take several times as long as in the fastest order. They would take most of the
/// time, and the order cannot be the best. Does nothing for kernels that have not run.
void end_plainly_slow(Plans& plans, std::vector<Samples>& samples, std::size_t kernels) {
  constexpr double kSlow = 3.0;
  // seconds; shorter runs may have been disturbed
  constexpr double kLongRun = 0.1;
  constexpr double kLongStretches = 0.05;
  for (std::size_t k = 0; k < kernels; ++k) {
    double fastest = std::numeric_limits<double>::infinity();
    for (const auto& of_order : plans) fastest = std::min(fastest, of_order[k].seconds);
    for (std::size_t i = 0; i < plans.size(); ++i) {
      Plan& plan = plans[i][k];
      const double least = plan.share < 1 ? kLongStretches / plan.share : kLongRun;
      if (plan.repeats == 0 || !plan.has_run() || plan.seconds < std::max(least, kSlow * fastest)) continue;
      samples[i][k] = {{plan.seconds}, plan.share};
      plan.repeats = 0;
    }
  }
}

std::vector<Samples> sample_interleaved(std::span<KernelBench* const> benches, const TimingOptions& options,
                                        double budget_seconds, SteadinessWatch& watch) {
  const std::size_t orders = benches.size();
  const std::span<const Kernel> kernels =
      benches.empty() ? std::span<const Kernel>() : benches.front()->kernels();
  Plans plans(orders);
  std::vector<Samples> samples(orders);
  const Stopwatch stopwatch;
  // the last kernels first: the first assembly computes the matrix of the product
  const auto plan_each = [&](const auto& plan) {
    for (std::size_t i = 0; i < orders; ++i) {
      for (std::size_t k = kernels.size(); k-- > 0;) {
        poll();
        if (plans[i][k].repeats > 0) plans[i][k] = plan(*benches[i], kernels[k], plans[i][k]);
      }
    }
    end_plainly_slow(plans, samples, kernels.size());
  };
  if (options.in_stretches) {
    plan_each([&](KernelBench& bench, Kernel kernel, const Plan& /*before*/) {
      return plan_by_stretches(bench, kernel, options);
    });
  }
  plan_each([&](KernelBench& bench, Kernel kernel, const Plan& before) {
    return plan_samples(bench, kernel, !before.has_run(), options);
  });
  double round_start = stopwatch.seconds();
  for (int round = 0; round < options.max_rounds; ++round) {
    const double seconds = stopwatch.seconds();
    if (round >= options.min_rounds && seconds + (seconds - round_start) > budget_seconds) break;
    round_start = seconds;
    for (std::size_t k = 0; k < kernels.size(); ++k) {
      watch.tick();
      for (std::size_t i = 0; i < orders; ++i) {
        const std::size_t order = (i + static_cast<std::size_t>(round)) % orders;
        poll();
        const Plan& plan = plans[order][k];
        if (plan.repeats == 0) continue;
        const RunTime time = round == 0 && plan.of_first_round ? *plan.of_first_round
                                                               : sample(*benches[order], kernels[k], plan);
        watch.add_sample(time.elapsed, time.on_thread);
        samples[order][k].seconds.push_back(time.by(options) / plan.repeats);
      }
    }
  }
  for (const Samples& of_order : samples) {
    for (const Kernel kernel : kernels) {
      const std::vector<double>& taken = of_order[static_cast<std::size_t>(kernel)].seconds;
      if (taken.size() > 1) watch.add_repeat(repeat_difference(taken));
    }
  }
  return samples;
}

KernelTimes summary(KernelSamples samples, double reference_seconds) {
  KernelTimes times;
  times.samples = static_cast<int>(samples.seconds.size());
  if (samples.seconds.empty()) return times;
  const double best = *std::ranges::min_element(samples.seconds);
  times.best_ms = 1e3 * best;
  times.speedup = best > 0.0 ? reference_seconds / best : 1.0;
  times.median_ms = 1e3 * median(std::move(samples.seconds));
  times.share = samples.share;
  return times;
}

std::vector<OrderTimes> summaries(std::vector<Samples> samples) {
  std::vector<OrderTimes> result(samples.size());
  for (const Kernel kernel : kKernels) {
    if (samples.empty() || of(samples.front(), kernel).seconds.empty()) continue;
    const double reference = *std::ranges::min_element(of(samples.front(), kernel).seconds);
    for (std::size_t i = 0; i < samples.size(); ++i)
      result[i][kernel] = summary(of(samples[i], kernel), reference);
  }
  return result;
}

}  // namespace

Timings time_interleaved(std::span<KernelBench* const> benches, const TimingOptions& options) {
  SteadinessWatch watch;
  std::vector<OrderTimes> orders =
      summaries(sample_interleaved(benches, options, options.budget_seconds, watch));
  return {std::move(orders), watch.result()};
}

Timings time_orders(Index orders, const PrepareOrder& prepare, const TimingOptions& options) {
  if (orders <= 0) return {};
  const std::unique_ptr<KernelBench> reference = prepare(0);
  const std::size_t memory = options.memory_bytes > 0 ? options.memory_bytes : usable_memory() / 2;
  const std::size_t fitting = memory / std::max<std::size_t>(1, reference->bytes());
  // number of benches that fit into memory together with the reference
  const Index group = static_cast<Index>(std::clamp<std::size_t>(fitting, 2, kMaxIndex)) - 1;
  const Index groups = std::max<Index>(1, (orders - 1 + group - 1) / group);

  std::vector<OrderTimes> result(1);
  SteadinessWatch watch;
  Samples of_reference;
  for (Index first = 1; first == 1 || first < orders; first += group) {
    std::vector<std::unique_ptr<KernelBench>> others;
    for (Index i = first; i < std::min(orders, first + group); ++i) others.push_back(prepare(i));
    std::vector<KernelBench*> benches{reference.get()};
    for (const auto& bench : others) benches.push_back(bench.get());
    std::vector<Samples> samples =
        sample_interleaved(benches, options, options.budget_seconds / groups, watch);
    for (const Kernel kernel : kKernels) {
      KernelSamples& all = of(of_reference, kernel);
      const KernelSamples& more = of(samples.front(), kernel);
      all.seconds.insert(all.seconds.end(), more.seconds.begin(), more.seconds.end());
      all.share = std::min(all.share, more.share);
    }
    const std::vector<OrderTimes> times = summaries(std::move(samples));
    result.insert(result.end(), times.begin() + 1, times.end());
  }
  std::vector<Samples> pooled;
  pooled.push_back(std::move(of_reference));
  result.front() = summaries(std::move(pooled)).front();
  return {std::move(result), watch.result()};
}

}  // namespace meshorder
