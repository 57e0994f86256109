// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "verdict.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace meshorder::command {
namespace {

std::string command_for(const Candidate& candidate) {
  return candidate.use == Workload::all ? "meshorder order"
                                        : fmt::format("meshorder order --for {}", to_string(candidate.use));
}

std::string methods_of(const Candidate& candidate) {
  return candidate.vertex_method.name + "/" + candidate.element_method.name;
}

std::string times(double count, const char* what) {
  return fmt::format("{} {}{}", with_commas(std::lround(count)), what, count == 1 ? "" : "s");
}

/// Returns the time steps after which a candidate has paid for itself, 0 if it never does.
double steps_to_pay(const Advice& advice, std::size_t candidate) {
  const double saved = saved_in_time_step(advice, candidate);
  return saved > 0 ? std::ceil(1e3 * advice.candidates[candidate].seconds / saved) : 0;
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
    const double as_is = advice.as_is.best_known()[k];
    if (as_is <= 0 || ordered[k] < same_time(kKernels[k], !advice.as_is.measured) * as_is) continue;
    words += fmt::format("{} the {} kernel {:.2g}× slower", words.empty() ? "; it makes" : " and",
                         kKernelTitles[k], ordered[k] / as_is);
  }
  return words;
}

/// Returns "4.1×", or "–" if a time is unknown.
std::string factor_cell(const std::optional<KernelMilliseconds>& as_is,
                        const std::optional<KernelMilliseconds>& ordered, std::size_t kernel) {
  if (!as_is || !ordered || (*ordered)[kernel] <= 0) return "–";
  return fmt::format("{:.2f}×", (*as_is)[kernel] / (*ordered)[kernel]);
}

nlohmann::ordered_json to_json(const std::optional<KernelMilliseconds>& milliseconds) {
  if (!milliseconds) return nullptr;
  nlohmann::ordered_json result;
  for (std::size_t k = 0; k < kKernels.size(); ++k)
    result[std::string(to_string(kKernels[k]))] = (*milliseconds)[k];
  return result;
}

nlohmann::ordered_json to_json(const OrderCosts& costs) {
  return {{"predicted_milliseconds", to_json(costs.predicted)},
          {"measured_milliseconds", to_json(costs.measured)}};
}

}  // namespace

std::string verdict_sentence(const Advice& advice) {
  const bool measured = advice.as_is.measured.has_value();
  const auto kernels = kernel_advice(advice);
  const std::size_t k = worst(kernels);
  if (kernels[k].factor <= 1) {
    return fmt::format(
        "nothing to gain: no kernel runs faster in another order, beyond the uncertainty of {}",
        measured ? "the measurement" : "the prediction");
  }
  // the order for all kernels, unless only another one makes this kernel faster
  const double with_first = advice.as_is.best_known()[k] / advice.candidates.front().costs.best_known()[k];
  const std::size_t taken = with_first >= same_time(kKernels[k], !measured) ? 0 : kernels[k].candidate;
  const Candidate& candidate = advice.candidates[taken];
  const double steps = steps_to_pay(advice, taken);
  const double factor = advice.as_is.best_known()[k] / candidate.costs.best_known()[k];
  const std::string pays =
      steps > 0
          ? "within " + times(steps, "time step")
          : fmt::format("within {} of the {} kernel",
                        times(std::ceil(1e3 * candidate.seconds /
                                        (advice.as_is.best_known()[k] - candidate.costs.best_known()[k])),
                              "run"),
                        kKernelTitles[k]);
  return fmt::format(
      "as it is, the {} kernel runs {:.1f}× slower than it could{}; `{}` takes {} and pays for itself {}{}",
      kKernelTitles[k], factor, measured ? "" : " (predicted)", command_for(candidate),
      duration(candidate.seconds), pays, losses(advice, taken));
}

void print_verdict(const Console& console, const Advice& advice) {
  const bool predicted = advice.as_is.predicted.has_value();
  const bool measured = advice.as_is.measured.has_value();
  console.print("\nKernels: time in the mesh's order, and how many times faster they run in another, {}",
                predicted && measured ? "measured here (predicted)"
                : measured            ? "measured here"
                                      : fmt::format("predicted for a {}", zen5_costs().machine));
  std::string header = fmt::format("{:<14}{:>10}", "", "as it is");
  for (const Candidate& candidate : advice.candidates) header += fmt::format("{:>18}", methods_of(candidate));
  console.print("{}", header);
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    std::string row =
        fmt::format("{:<14}{:>10}", kKernelTitles[k], duration(1e-3 * advice.as_is.best_known()[k]));
    for (const Candidate& candidate : advice.candidates) {
      const std::string of_model = factor_cell(advice.as_is.predicted, candidate.costs.predicted, k);
      const std::string of_clock = factor_cell(advice.as_is.measured, candidate.costs.measured, k);
      row += fmt::format("{:>18}", predicted && measured ? fmt::format("{} ({})", of_clock, of_model)
                                   : measured            ? of_clock
                                                         : of_model);
    }
    console.print("{}", row);
  }
  for (std::size_t i = 0; i < advice.candidates.size(); ++i) {
    const Candidate& candidate = advice.candidates[i];
    const double steps = steps_to_pay(advice, i);
    console.print("{}: `{}`, {}, {}", methods_of(candidate), command_for(candidate),
                  duration(candidate.seconds),
                  steps > 0 ? "pays off after " + times(steps, "time step") : "saves nothing in a time step");
  }
  console.print("A time step here: one run of element force and of assembly, {} runs of SpMV",
                kRunsInTimeStep[0]);
  console.print("\nVerdict: {}", verdict_sentence(advice));
}

nlohmann::ordered_json to_json(const Advice& advice) {
  const auto of_kernels = kernel_advice(advice);
  nlohmann::ordered_json kernels;
  nlohmann::ordered_json time_step;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    const KernelAdvice& of_kernel = of_kernels[k];
    const bool gains = of_kernel.factor > 1;
    kernels[std::string(to_string(kKernels[k]))] = {
        {"factor", of_kernel.factor},
        {"order", gains ? nlohmann::ordered_json(of_kernel.candidate) : nullptr},
        {"runs_to_pay", gains ? nlohmann::ordered_json(of_kernel.runs_to_pay) : nullptr}};
    time_step[std::string(to_string(kKernels[k]))] = kRunsInTimeStep[k];
  }
  auto orders = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < advice.candidates.size(); ++i) {
    const Candidate& candidate = advice.candidates[i];
    const double steps = steps_to_pay(advice, i);
    nlohmann::ordered_json order{{"command", command_for(candidate)},
                                 {"vertices", candidate.vertex_method.name},
                                 {"elements", candidate.element_method.name},
                                 {"seconds", candidate.seconds},
                                 {"time_steps_to_pay", steps > 0 ? nlohmann::ordered_json(steps) : nullptr}};
    order.update(to_json(candidate.costs));
    orders.push_back(order);
  }
  return {{"sentence", verdict_sentence(advice)},
          {"by", advice.as_is.measured ? "measurement" : "prediction"},
          {"kernels", kernels},
          {"as_it_is", to_json(advice.as_is)},
          {"orders", orders},
          {"time_step", time_step}};
}

}  // namespace meshorder::command
