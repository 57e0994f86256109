// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/advice.hpp"
#include "payoff/kernel_bench.hpp"
#include "payoff/quantities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace meshorder {

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

/// Returns the kernel that loses most in the mesh's order.
std::size_t worst(const std::array<KernelAdvice, kKernels.size()>& kernels) {
  const auto less = [](const KernelAdvice& a, const KernelAdvice& b) { return a.factor < b.factor; };
  return static_cast<std::size_t>(std::max_element(kernels.begin(), kernels.end(), less) - kernels.begin());
}

/// Returns the kernels that run slower in a candidate: "; it makes the springs kernel 1.2× slower".
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

/// Whether by how much a kernel gains is in doubt: the times are not to be trusted, and the gain is less than
/// four times what two timings of the same differ by.
bool is_vague(const Advice& advice, std::size_t kernel, double factor) {
  constexpr double kBeyondNoise = 4;
  constexpr double kLeastNoise = 0.05;
  return !advice.doubt.empty() && factor - 1 < kBeyondNoise * std::max(kLeastNoise, advice.floor[kernel]);
}

/// The verdict where it is: the direction alone.
std::string in_doubt(const std::string& runs, const char* how, const std::string& on,
                     const std::string& command) {
  return fmt::format(
      "as it is, {} {}{} than it could (measured here while the machine was busy: by how much is in doubt); "
      "`{}` mends it",
      runs, how, on, command);
}

/// The verdict on a matrix.
std::string of_products(const Advice& advice) {
  const bool measured = advice.as_is.costs.measured.has_value();
  const std::string on = measured ? on_threads(advice.threads) : "";
  const std::string of_machine = advice.machine.empty() ? "" : " for " + advice.machine;
  const KernelAdvice& product = advice.kernels.front();
  if (product.factor <= 1) {
    return fmt::format(
        "nothing to gain: products take no less time in another order, beyond the uncertainty of {}",
        measured ? "the measurement" + on : "the prediction" + of_machine);
  }
  const Candidate& candidate = advice.candidates[product.candidate];
  if (is_vague(advice, 0, product.factor))
    return in_doubt("products take", "longer", on, command_for(candidate, true));
  return fmt::format(
      "as it is, products take {:.1f}× as long{} as they could{}; `{}` takes {} and pays after {}",
      product.factor, on, measured ? " (measured here)" : " (predicted" + of_machine + ")",
      command_for(candidate, true), duration(candidate.order_seconds), times(product.runs_to_pay, "product"));
}

}  // namespace

std::optional<std::size_t> advised(const Advice& advice) {
  const std::size_t k = worst(advice.kernels);
  if (advice.kernels[k].factor <= 1) return std::nullopt;
  if (advice.is_matrix) return advice.kernels[k].candidate;
  // the order for all kernels, unless only another one makes this kernel faster
  const double with_first =
      advice.as_is.costs.best_known()[k] / advice.candidates.front().costs.best_known()[k];
  return with_first >= same_time(advice, kKernels[k]) ? 0 : advice.kernels[k].candidate;
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
        "nothing to gain: no kernel runs faster in another order, beyond the uncertainty of {}",
        measured ? "the measurement" + on_threads(advice.threads) : "the prediction" + of_machine);
  }
  const Candidate& candidate = advice.candidates[*taken];
  const double steps = steps_to_pay(advice, *taken);
  const double factor = advice.as_is.costs.best_known()[k] / candidate.costs.best_known()[k];
  if (is_vague(advice, k, factor)) {
    return in_doubt(fmt::format("the {} kernel runs", kKernelTitles[k]), "slower", on_threads(advice.threads),
                    command_for(candidate));
  }
  const std::string pays =
      steps > 0 ? "within " + times(steps, "time step")
                : fmt::format(
                      "within {} of the {} kernel",
                      times(std::ceil(1e3 * candidate.order_seconds /
                                      (advice.as_is.costs.best_known()[k] - candidate.costs.best_known()[k])),
                            "run"),
                      kKernelTitles[k]);
  return fmt::format(
      "as it is, the {} kernel runs {:.1f}× slower{} than it could{}; `{}` takes {} and pays for itself {}{}",
      kKernelTitles[k], factor, measured ? on_threads(advice.threads) : "",
      measured ? " (measured here)" : " (predicted" + of_machine + ")", command_for(candidate),
      duration(candidate.order_seconds), pays, losses(advice, *taken));
}

}  // namespace v0_3
}  // namespace meshorder
