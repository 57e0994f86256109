// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/kernel_timing.hpp"

#include "base/median.hpp"
#include "base/memory.hpp"
#include "base/run_scope.hpp"
#include "base/stopwatch.hpp"
#include "payoff/paired_trials.hpp"

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

/// The samples of all orders, and of the first one once more.
struct Sampled {
  std::vector<Samples> orders;
  Samples again;
};

/// Runs benches, all of them in the same memory unless they are large.
class Stage {
 public:
  explicit Stage(std::span<KernelBench* const> benches) : benches_(benches) {
    const auto is_small = [](const KernelBench* bench) { return bench->bytes() <= kMostCopied; };
    if (!benches.empty() && std::ranges::all_of(benches, is_small)) shared_ = benches.front()->copy();
  }

  /// Returns the bench of order i, which runs until the next call.
  KernelBench& enter(std::size_t i) {
    if (!shared_) return *benches_[i];
    shared_->take(*benches_[i]);
    return *shared_;
  }
  /// Keeps what order i has computed, such as its matrix.
  void keep(std::size_t i) {
    if (shared_) benches_[i]->take(*shared_);
  }

 private:
  std::span<KernelBench* const> benches_;
  std::unique_ptr<KernelBench> shared_;
};

Sampled sample_interleaved(std::span<KernelBench* const> benches, const TimingOptions& options,
                           double budget_seconds, SteadinessWatch& watch) {
  const std::size_t orders = benches.size();
  const std::span<const Kernel> kernels =
      benches.empty() ? std::span<const Kernel>() : benches.front()->kernels();
  Plans plans(orders);
  Sampled sampled{std::vector<Samples>(orders), {}};
  Stage stage(benches);
  const Stopwatch stopwatch;
  // the last kernels first: the first assembly computes the matrix of the product
  const auto plan_each = [&](const auto& plan) {
    for (std::size_t i = 0; i < orders; ++i) {
      KernelBench& bench = stage.enter(i);
      for (std::size_t k = kernels.size(); k-- > 0;) {
        poll();
        if (plans[i][k].repeats > 0) plans[i][k] = plan(bench, kernels[k], plans[i][k]);
      }
      stage.keep(i);
    }
    end_plainly_slow(plans, sampled.orders, kernels.size());
  };
  if (options.in_stretches) {
    plan_each([&](KernelBench& bench, Kernel kernel, const Plan& /*before*/) {
      return plan_by_stretches(bench, kernel, options);
    });
  }
  plan_each([&](KernelBench& bench, Kernel kernel, const Plan& before) {
    return plan_samples(bench, kernel, !before.has_run(), options);
  });
  const std::size_t places = orders > 0 ? orders + 1 : 0;
  double round_start = stopwatch.seconds();
  for (int round = 0; round < options.max_rounds; ++round) {
    const double seconds = stopwatch.seconds();
    if (round >= options.min_rounds && seconds + (seconds - round_start) > budget_seconds) break;
    round_start = seconds;
    for (std::size_t place = 0; place < places; ++place) {
      const std::size_t turn = (place + static_cast<std::size_t>(round)) % places;
      const std::size_t order = turn % orders;
      Samples& samples = turn < orders ? sampled.orders[order] : sampled.again;
      watch.tick();
      KernelBench& bench = stage.enter(order);
      for (std::size_t k = 0; k < kernels.size(); ++k) {
        poll();
        const Plan& plan = plans[order][k];
        if (plan.repeats == 0) continue;
        const bool is_taken = round == 0 && turn < orders && plan.of_first_round;
        const RunTime time = is_taken ? *plan.of_first_round : sample(bench, kernels[k], plan);
        watch.add_sample(time.elapsed, time.on_thread);
        samples[k].seconds.push_back(time.by(options) / plan.repeats);
      }
    }
  }
  return sampled;
}

/// Returns log(reference / sample) for each round; of orders that were not sampled in the same rounds, that
/// of their best samples.
std::vector<double> log_ratios(const std::vector<double>& reference, const std::vector<double>& samples) {
  std::vector<double> logs;
  if (reference.size() != samples.size()) {
    logs.push_back(std::log(*std::ranges::min_element(reference) / *std::ranges::min_element(samples)));
    return logs;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) logs.push_back(std::log(reference[i] / samples[i]));
  return logs;
}

/// Returns the ratio with its interval, whose ends are moved apart by `noise`, a logarithm.
TimeRatio ratio_of(const std::vector<double>& logs, const std::vector<double>& control, double noise) {
  constexpr double kOfOneSample = 1.25;
  TimeRatio ratio = time_ratio_of(logs, control);
  if (logs.size() == 1) ratio = {ratio.ratio, ratio.ratio / kOfOneSample, ratio.ratio * kOfOneSample};
  return {ratio.ratio, ratio.low * std::exp(-noise), ratio.high * std::exp(noise)};
}

KernelTimes summary(const KernelSamples& samples) {
  KernelTimes times;
  times.samples = static_cast<int>(samples.seconds.size());
  if (samples.seconds.empty()) return times;
  times.best_ms = 1e3 * *std::ranges::min_element(samples.seconds);
  times.median_ms = 1e3 * median(samples.seconds);
  times.share = samples.share;
  return times;
}

/// Adds the steadiness; of an unreliable measurement, no ratio has an interval.
Timings judged(Timings timings, const SteadinessWatch& watch) {
  timings.steadiness = watch.result();
  if (reason_to_doubt(timings.steadiness).empty()) return timings;
  for (std::size_t i = 1; i < timings.orders.size(); ++i) {
    for (KernelTimes& times : timings.orders[i].times) times.gain = {.ratio = times.gain.ratio};
  }
  return timings;
}

/// Returns the times of all orders; adds what the two times of the first one differ by to the watch.
Timings summaries(const Sampled& sampled, SteadinessWatch& watch) {
  // times of one problem on a quiet machine differ by up to this share from one process to the next
  constexpr double kLeastNoise = 0.015;
  Timings result;
  result.orders.resize(sampled.orders.size());
  for (const Kernel kernel : kKernels) {
    const auto k = static_cast<std::size_t>(kernel);
    if (sampled.orders.empty() || sampled.orders.front()[k].seconds.empty()) continue;
    const std::vector<double>& reference = sampled.orders.front()[k].seconds;
    double noise = kLeastNoise;
    std::vector<double> control;
    result.again[kernel] = summary(sampled.again[k]);
    if (!sampled.again[k].seconds.empty()) {
      control = log_ratios(reference, sampled.again[k].seconds);
      result.again[kernel].gain = ratio_of(control, {}, kLeastNoise);
      const double differ = std::abs(std::log(result.again[kernel].gain.ratio));
      watch.add_repeat(std::expm1(differ));
      noise = std::max(noise, differ);
    }
    for (std::size_t i = 0; i < sampled.orders.size(); ++i) {
      result.orders[i][kernel] = summary(sampled.orders[i][k]);
      if (i > 0)
        result.orders[i][kernel].gain =
            ratio_of(log_ratios(reference, sampled.orders[i][k].seconds), control, noise);
    }
  }
  return result;
}

}  // namespace

Timings time_interleaved(std::span<KernelBench* const> benches, const TimingOptions& options) {
  SteadinessWatch watch;
  Timings result = summaries(sample_interleaved(benches, options, options.budget_seconds, watch), watch);
  return judged(std::move(result), watch);
}

Timings time_orders(Index orders, const PrepareOrder& prepare, const TimingOptions& options) {
  if (orders <= 0) return {};
  const std::unique_ptr<KernelBench> reference = prepare(0);
  const std::size_t memory = options.memory_bytes > 0 ? options.memory_bytes : usable_memory() / 2;
  const std::size_t fitting = memory / std::max<std::size_t>(1, reference->bytes());
  // number of benches that fit into memory together with the reference
  const Index group = static_cast<Index>(std::clamp<std::size_t>(fitting, 2, kMaxIndex)) - 1;
  const Index groups = std::max<Index>(1, (orders - 1 + group - 1) / group);

  Timings result;
  SteadinessWatch watch;
  Samples of_reference;
  for (Index first = 1; first == 1 || first < orders; first += group) {
    std::vector<std::unique_ptr<KernelBench>> others;
    for (Index i = first; i < std::min(orders, first + group); ++i) others.push_back(prepare(i));
    std::vector<KernelBench*> benches{reference.get()};
    for (const auto& bench : others) benches.push_back(bench.get());
    const Sampled sampled = sample_interleaved(benches, options, options.budget_seconds / groups, watch);
    for (const Kernel kernel : kKernels) {
      KernelSamples& all = of(of_reference, kernel);
      const KernelSamples& more = sampled.orders.front()[static_cast<std::size_t>(kernel)];
      all.seconds.insert(all.seconds.end(), more.seconds.begin(), more.seconds.end());
      all.share = std::min(all.share, more.share);
    }
    const Timings times = summaries(sampled, watch);
    if (first == 1)
      result = times;
    else
      result.orders.insert(result.orders.end(), times.orders.begin() + 1, times.orders.end());
  }
  for (const Kernel kernel : kKernels) result.orders.front()[kernel] = summary(of(of_reference, kernel));
  return judged(std::move(result), watch);
}

}  // namespace meshorder
