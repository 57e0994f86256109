// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/advice.hpp"
#include "payoff/kernel_bench.hpp"
#include "payoff/quantities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
  const auto less = [](const KernelAdvice& a, const KernelAdvice& b) { return a.factor < b.factor; };
  return static_cast<std::size_t>(std::max_element(kernels.begin(), kernels.end(), less) - kernels.begin());
}

/// Returns a clause on the kernels that a candidate slows down: "; it makes the springs kernel 1.2× slower".
std::string losses(const Advice& advice, std::size_t candidate) {
  std::string words;
  const KernelMilliseconds& ordered = advice.candidates[candidate].costs.best_known();
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    const double as_is = advice.as_is.costs.best_known()[k];
    if (as_is <= 0 || ordered[k] < same_time(advice, kKernels[k]) * as_is) continue;
    words += fmt::format("{} the {} kernel {:.2g}× slower", words.empty() ? "; it makes" : " and",
                         kKernelTitles[k], ordered[k] / as_is);
  }
  return words;
}

/// Returns whether the size of a kernel's gain is in doubt: the times are unreliable, and the gain is less
/// than four times the difference of repeated timings, taken as at least 5 %.
bool is_vague(const Advice& advice, std::size_t kernel, double factor) {
  constexpr double kBeyondNoise = 4;
  constexpr double kLeastNoise = 0.05;
  return !advice.doubt.empty() && factor - 1 < kBeyondNoise * std::max(kLeastNoise, advice.floor[kernel]);
}

/// Returns whether the mean gain of a workload's kernels is in doubt by the noise of one of them.
bool is_vague(const Advice& advice, Workload workload, double factor) {
  for (std::size_t k = 0; k < kernels_of(advice).size(); ++k) {
    const bool counts = workload == Workload::all || k == kernel_of(workload);
    if (counts && is_vague(advice, k, factor)) return true;
  }
  return false;
}

/// Returns the number of runs of a kernel after which a candidate that makes it faster has paid for itself:
/// "17 runs of the springs kernel".
std::string runs_to_pay(const Advice& advice, const Candidate& candidate, std::size_t kernel) {
  const double saved_ms = advice.as_is.costs.best_known()[kernel] - candidate.costs.best_known()[kernel];
  return fmt::format("{} of the {} kernel", times(std::ceil(1e3 * candidate.order_seconds / saved_ms), "run"),
                     kKernelTitles[kernel]);
}

/// Returns "the springs kernel runs" or "the kernels run"; for a matrix "products are".
std::string runs_of(const Advice& advice, Workload workload) {
  if (advice.is_matrix) return "products are";
  const std::size_t k = kernel_of(workload);
  return k < kKernels.size() ? fmt::format("the {} kernel runs", kKernelTitles[k]) : "the kernels run";
}

/// Returns the verdict if the size of the gain is in doubt. It says only which order is faster. `slower` is a
/// text such as "products take longer", `than` a text such as "they could".
std::string in_doubt(const std::string& slower, const std::string& on, const char* than,
                     const std::string& command) {
  return fmt::format(
      "as it is, {}{} than {} (measured here while the machine was busy: the amount is uncertain); `{}` "
      "gives a faster order",
      slower, on, than, command);
}

std::string of_products(const Advice& advice) {
  const bool measured = advice.as_is.costs.measured.has_value();
  const std::string on = measured ? on_threads(advice.threads) : "";
  const std::string of_machine = advice.machine.empty() ? "" : " for " + advice.machine;
  const KernelAdvice& product = advice.kernels.front();
  if (product.factor <= 1) {
    return fmt::format(
        "nothing to gain: products are no faster in another order, within the uncertainty of {}",
        measured ? "the measurement" + on : "the prediction" + of_machine);
  }
  const Candidate& candidate = advice.candidates[product.candidate];
  if (is_vague(advice, 0, product.factor))
    return in_doubt("products take longer", on, "they could", command_for(candidate, true));
  return fmt::format(
      "as it is, products take {:.1f}× as long{} as they could{}; `{}` takes {} and pays off after {}",
      product.factor, on, measured ? " (measured here)" : " (predicted" + of_machine + ")",
      command_for(candidate, true), duration(candidate.order_seconds), times(product.runs_to_pay, "product"));
}

}  // namespace

std::optional<std::size_t> advised(const Advice& advice) {
  const std::size_t k = worst(advice.kernels);
  if (advice.kernels[k].factor <= 1) return std::nullopt;
  if (advice.is_matrix) return advice.kernels[k].candidate;
  // the order for all kernels, unless it does not make this kernel faster
  const double with_first =
      advice.as_is.costs.best_known()[k] / advice.candidates.front().costs.best_known()[k];
  return with_first >= same_time(advice, kKernels[k]) ? 0 : advice.kernels[k].candidate;
}

std::optional<double> certain_gain(const Advice& advice) {
  const std::optional<std::size_t> taken = advised(advice);
  if (!taken) return std::nullopt;
  const std::size_t k = worst(advice.kernels);
  const double factor = advice.as_is.costs.best_known()[k] / advice.candidates[*taken].costs.best_known()[k];
  return is_vague(advice, k, factor) ? std::nullopt : std::optional(factor);
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
    const std::size_t k = worst(advice.kernels);
    // require twice the margin: with many orders, the best factor for one kernel also exceeds 1 by chance
    if (is_mean && advice.kernels[k].factor > 1 + 2 * (same_time(advice, kKernels[k]) - 1)) {
      return fmt::format("no order is better for all kernels; best for the {} kernel is {}", kKernelTitles[k],
                         order_in_words(advice.candidates[advice.kernels[k].candidate]));
    }
    return fmt::format(
        "nothing to gain: {} no faster in these orders than in the file's own, within the uncertainty of the "
        "measurement{}",
        runs, on_threads(advice.threads));
  }
  const Candidate& candidate = advice.candidates[*best];
  const double factor = factor_for(judged, advice, *best);
  const std::string order = order_in_words(candidate, advice.is_matrix);
  if (is_vague(advice, judged, factor)) {
    return fmt::format(
        "{} faster{} in {} than in the file's own order (measured while the machine was busy: the amount "
        "is uncertain)",
        runs, on_threads(advice.threads), order);
  }
  const double steps = steps_to_pay(advice, *best);
  std::string pays;
  if (judged != Workload::all && !advice.is_matrix) {
    pays = " and pays off after " + runs_to_pay(advice, candidate, kernel_of(judged));
  } else if (steps > 0) {
    pays = " and pays off after " + times(steps, advice.is_matrix ? "product" : "time step");
  }
  return fmt::format("{} {:.2f}× faster{} in {} than in the file's own order{}; it takes {}{}", runs, factor,
                     on_threads(advice.threads), order, is_mean ? ", in their geometric mean" : "",
                     duration(candidate.order_seconds), pays);
}

inline namespace v0_3 {

std::string to_string(const Advice& advice) {
  if (advice.is_matrix) return of_products(advice);
  const std::optional<std::size_t> taken = advised(advice);
  const bool measured = advice.as_is.costs.measured.has_value();
  const std::string of_machine = advice.machine.empty() ? "" : " for " + advice.machine;
  const auto& kernels = advice.kernels;
  const std::size_t k = worst(kernels);
  if (!taken) {
    return fmt::format(
        "nothing to gain: no kernel runs faster in another order, within the uncertainty of {}",
        measured ? "the measurement" + on_threads(advice.threads) : "the prediction" + of_machine);
  }
  const Candidate& candidate = advice.candidates[*taken];
  const double steps = steps_to_pay(advice, *taken);
  const double factor = advice.as_is.costs.best_known()[k] / candidate.costs.best_known()[k];
  if (is_vague(advice, k, factor)) {
    return in_doubt(fmt::format("the {} kernel runs slower", kKernelTitles[k]), on_threads(advice.threads),
                    "it could", command_for(candidate));
  }
  const std::string pays = steps > 0 ? times(steps, "time step") : runs_to_pay(advice, candidate, k);
  return fmt::format(
      "as it is, the {} kernel runs {:.1f}× slower{} than it could{}; `{}` takes {} and pays for itself "
      "within {}{}",
      kKernelTitles[k], factor, measured ? on_threads(advice.threads) : "",
      measured ? " (measured here)" : " (predicted" + of_machine + ")", command_for(candidate),
      duration(candidate.order_seconds), pays, losses(advice, *taken));
}

}  // namespace v0_3
}  // namespace meshorder
