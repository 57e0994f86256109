// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/advice.hpp"
#include "payoff/kernel_bench.hpp"
#include "payoff/quantities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace meshorder {

std::size_t kernel_of(Workload workload) {
  const auto found =
      std::ranges::find_if(kKernels, [&](Kernel kernel) { return to_string(kernel) == to_string(workload); });
  return static_cast<std::size_t>(found - kKernels.begin());
}

std::string command_for(const Candidate& candidate, bool is_matrix) {
  const bool by_auto =
      !candidate.vertices.reason.empty() && (is_matrix || !candidate.elements.reason.empty());
  if (!by_auto && is_matrix) return fmt::format("meshorder order --vertices {}", candidate.vertices.name);
  if (!by_auto) {
    return fmt::format("meshorder order --vertices {} --elements {}", candidate.vertices.name,
                       candidate.elements.name);
  }
  return candidate.workload == Workload::all
             ? "meshorder order"
             : fmt::format("meshorder order --for {}", to_string(candidate.workload));
}

namespace {

std::string times(double count, const char* what) {
  return fmt::format("{} {}{}", with_commas(std::lround(count)), what, count == 1 ? "" : "s");
}

/// Returns the place of the kernel that could gain most over the mesh's own order.
std::size_t worst(const std::array<KernelAdvice, kKernels.size()>& kernels) {
  const auto less = [](const KernelAdvice& a, const KernelAdvice& b) { return a.gain.ratio < b.gain.ratio; };
  return static_cast<std::size_t>(std::max_element(kernels.begin(), kernels.end(), less) - kernels.begin());
}

/// Returns a clause on the kernels that a candidate slows down: "; it makes the springs kernel 1.1 to 1.2
/// times slower".
std::string losses(const Advice& advice, std::size_t candidate) {
  std::string words;
  for (std::size_t k = 0; k < kernels_of(advice).size(); ++k) {
    const TimeRatio gain = gain_of(advice, advice.candidates[candidate], k);
    if (gain.ratio >= 1 || !is_told_apart(gain)) continue;
    const TimeRatio loss{1 / gain.ratio, 1 / gain.high, 1 / gain.low};
    words += fmt::format("{} the {} kernel {} times slower", words.empty() ? "; it makes" : " and",
                         kKernelTitles[k], range_in_words(loss));
  }
  return words;
}

/// Returns "measured here on 2 threads" or "predicted for zen3".
std::string source_of(const Advice& advice) {
  return is_measured(advice) ? "measured here" + on_threads(advice.threads)
                             : "predicted for " + advice.machine;
}

/// Returns "the springs kernel runs" or "the kernels run"; for a matrix "products are".
std::string runs_of(const Advice& advice, Workload workload) {
  if (advice.is_matrix) return "products are";
  const std::size_t k = kernel_of(workload);
  return k < kKernels.size() ? fmt::format("the {} kernel runs", kKernelTitles[k]) : "the kernels run";
}

/// Returns why no order is told apart from the present one: nothing is to be gained or, if gains of more than
/// `kSmall` are possible, the gain is not known. `most` is the largest end of the intervals.
std::string no_gain(const Advice& advice, double most, const std::string& runs) {
  constexpr double kSmall = 1.3;
  if (!is_measured(advice) && !advice.as_is.costs.predicted) return "the gain is not known: " + advice.doubt;
  const std::string source = source_of(advice);
  if (most > kSmall) {
    return std::isinf(most)
               ? "the gain is not known: the times were not told apart"
               : fmt::format("the gain is not known: up to {:.1f} times is possible ({})", most, source);
  }
  return fmt::format("nothing to gain: {} more than {:.2f} times as fast in another order ({})", runs, most,
                     source);
}

/// Returns the largest end of a candidate's intervals, over the kernels of a workload.
double most_of(const Advice& advice, Workload workload) {
  double most = 1;
  for (const Candidate& candidate : advice.candidates) {
    for (std::size_t k = 0; k < kernels_of(advice).size(); ++k) {
      if (workload == Workload::all || k == kernel_of(workload))
        most = std::max(most, gain_of(advice, candidate, k).high);
    }
  }
  return most;
}

}  // namespace

OrderGrade grade_of(const Quality& as_is, const Quality& ordered, Index vertices) {
  constexpr double kGood = 1.0 / 6;
  constexpr double kFair = 0.5;
  // mean of log2 |x - y| for x and y spread evenly over 0 … n
  const double random = std::log2(std::max<double>(2, vertices)) - 1.5 / std::numbers::ln2;
  const double way = random - ordered.mean_log2_span;
  const double gone = as_is.mean_log2_span - ordered.mean_log2_span;
  if (gone <= std::max(0.0, kGood * way)) return OrderGrade::good;
  return gone <= kFair * way ? OrderGrade::fair : OrderGrade::poor;
}

std::string grade_in_words(const Advice& advice, Index vertices) {
  const Quality& as_is = advice.as_is.spans;
  const Quality& ordered = advice.candidates.front().spans;
  const auto places = [](double mean) {
    return mean < 9.95 ? fmt::format("{:.1f}", mean) : with_commas(std::lround(mean));
  };
  return fmt::format("{}: neighbours are {} places apart on average; `{}` makes it {}, random would be {}",
                     to_string(grade_of(as_is, ordered, vertices)), places(as_is.mean_span),
                     command_for(advice.candidates.front(), advice.is_matrix), places(ordered.mean_span),
                     places((vertices + 1) / 3.0));
}

std::string range_in_words(const TimeRatio& ratio) {
  const auto in_words = [](double number) { return fmt::format("{:.{}f}", number, number < 1.995 ? 2 : 1); };
  const std::string low = in_words(ratio.low);
  const std::string high = in_words(ratio.high);
  return low == high ? low : low + " to " + high;
}

std::optional<std::size_t> advised(const Advice& advice) {
  const std::size_t k = worst(advice.kernels);
  const KernelAdvice& of_worst = advice.kernels[k];
  if (of_worst.gain.ratio <= 1) return std::nullopt;
  if (advice.is_matrix) return of_worst.candidate;
  // the order for all kernels, unless it does not make this kernel faster
  const TimeRatio with_first = gain_of(advice, advice.candidates.front(), k);
  return with_first.ratio > 1 && is_told_apart(with_first) ? 0 : of_worst.candidate;
}

std::optional<TimeRatio> certain_gain(const Advice& advice) {
  const std::optional<std::size_t> taken = advised(advice);
  if (!taken) return std::nullopt;
  return gain_of(advice, advice.candidates[*taken], worst(advice.kernels));
}

Workload judged_by_kernels(const Advice& advice, Workload workload) {
  return kernel_of(workload) < kernels_of(advice).size() ? workload : Workload::all;
}

std::string order_in_words(const Candidate& candidate, bool is_matrix) {
  const std::string& vertices = candidate.vertices.name;
  const std::string& elements = candidate.elements.name;
  const bool moves_both_alike = vertices == "original" || vertices == "scrambled";
  const bool is_usual = elements == (moves_both_alike ? vertices : "lexmax");
  return is_matrix || is_usual ? vertices : vertices + "/" + elements;
}

std::string comparison_in_words(const Advice& advice, Workload workload) {
  const Workload judged = judged_by_kernels(advice, workload);
  const bool is_mean = judged == Workload::all && !advice.is_matrix;
  const std::string runs = runs_of(advice, judged);
  const std::optional<std::size_t> best = winner_for(judged, advice);
  if (!best) {
    const KernelAdvice& of_worst = advice.kernels[worst(advice.kernels)];
    if (is_mean && of_worst.gain.ratio > 1) {
      return fmt::format("no order is better for all kernels; best for the {} kernel is {}",
                         kKernelTitles[worst(advice.kernels)],
                         order_in_words(advice.candidates[of_worst.candidate]));
    }
    return no_gain(advice, most_of(advice, judged), advice.is_matrix ? "products are not" : "no kernel is");
  }
  const Candidate& candidate = advice.candidates[*best];
  const double steps = steps_to_pay(advice, *best);
  std::string pays;
  if (judged != Workload::all && !advice.is_matrix) {
    const std::size_t k = kernel_of(judged);
    pays = fmt::format(" and pays off after {} of that kernel",
                       times(std::ceil(1e3 * candidate.order_seconds / saved_ms(advice, *best, k)), "run"));
  } else if (steps > 0) {
    pays = " and pays off after " + times(steps, advice.is_matrix ? "product" : "time step");
  }
  return fmt::format("{} {} times faster{} in {} than in the file's own order{}; it takes {}{}", runs,
                     range_in_words(gain_for(judged, advice, *best)), on_threads(advice.threads),
                     order_in_words(candidate, advice.is_matrix), is_mean ? ", in their geometric mean" : "",
                     duration(candidate.order_seconds), pays);
}

inline namespace v0_3 {

std::string to_string(const Advice& advice) {
  const std::optional<std::size_t> taken = advised(advice);
  if (!taken) {
    return no_gain(advice, most_of(advice, Workload::all),
                   advice.is_matrix ? "products are not" : "no kernel is");
  }
  const std::size_t k = worst(advice.kernels);
  const Candidate& candidate = advice.candidates[*taken];
  const TimeRatio gain = gain_of(advice, candidate, k);
  const std::string subject =
      advice.is_matrix ? "products take" : fmt::format("the {} kernel takes", kKernelTitles[k]);
  const double runs = std::ceil(1e3 * candidate.order_seconds / saved_ms(advice, *taken, k));
  return fmt::format("as it is, {} {} times as long as {} could ({}); `{}` takes {} and pays off after {}{}",
                     subject, range_in_words(gain), advice.is_matrix ? "they" : "it", source_of(advice),
                     command_for(candidate, advice.is_matrix), duration(candidate.order_seconds),
                     advice.is_matrix ? times(runs, "product") : times(runs, "run") + " of it",
                     losses(advice, *taken));
}

}  // namespace v0_3
}  // namespace meshorder
