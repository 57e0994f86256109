// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "verdict.hpp"

#include "payoff/advice.hpp"
#include "payoff/kernel_bench.hpp"
#include "payoff/machine_choice.hpp"
#include "payoff/paired_trials.hpp"
#include "reuse_report.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string_view>

namespace meshorder::command {
namespace {

std::string methods_of(const Candidate& candidate, bool is_matrix) {
  return is_matrix ? candidate.vertices.name : candidate.vertices.name + "/" + candidate.elements.name;
}

/// Returns "1.34×", or "not told apart".
std::string factor_cell(const TimeRatio& gain) {
  return is_told_apart(gain) ? fmt::format("{:.2f}×", gain.ratio) : std::string(kNotToldApart);
}

nlohmann::ordered_json milliseconds_json(const std::optional<KernelMilliseconds>& milliseconds,
                                         std::size_t kernels) {
  if (!milliseconds) return nullptr;
  nlohmann::ordered_json result;
  for (std::size_t k = 0; k < kernels; ++k) result[std::string(to_string(kKernels[k]))] = (*milliseconds)[k];
  return result;
}

nlohmann::ordered_json costs_json(const OrderCosts& costs, std::size_t kernels) {
  return {{"predicted_milliseconds", milliseconds_json(costs.predicted, kernels)},
          {"measured_milliseconds", milliseconds_json(costs.measured, kernels)}};
}

/// Returns "pays off after 18 time steps"; for a matrix, "… 18 products".
std::string pays_in_words(const Advice& advice, std::size_t candidate) {
  const double steps = steps_to_pay(advice, candidate);
  const char* const what = advice.is_matrix ? "product" : "time step";
  return steps > 0 ? fmt::format("pays off after {} {}{}", with_commas(std::lround(steps)), what,
                                 steps == 1 ? "" : "s")
                   : fmt::format("saves nothing in a {}", what);
}

constexpr std::string_view kCommand = "meshorder order";

}  // namespace

void print_line_for(const Console& console, const Candidate& candidate, bool is_matrix,
                    const std::string& mesh) {
  console.print("{:<12} {} {} -o {}{}", "to order it", kCommand, in_shell(mesh), in_shell(ordered_name(mesh)),
                command_for(candidate, is_matrix).substr(kCommand.size()));
}

void print_next(const Console& console, const Advice& advice, const std::string& mesh) {
  const Candidate& first = advice.candidates.front();
  const bool moves = first.vertices.name != "original" || first.elements.name != "original";
  if (const std::optional<std::size_t> candidate = advised(advice)) {
    print_line_for(console, advice.candidates[*candidate], advice.is_matrix, mesh);
  } else if (moves) {
    print_line_for(console, first, advice.is_matrix, mesh);
  }
}

void print_times(const Console& console, const Advice& advice) {
  const bool predicted = advice.as_is.costs.predicted.has_value();
  const bool measured = is_measured(advice);
  if (!predicted && !measured) return;
  console.print("\n{}, and how many times faster {} in another,\n{}",
                advice.is_matrix
                    ? "Products: time in the file's order"
                    : fmt::format("Kernels ({}): time in the mesh's order", to_string(advice.kernel_set)),
                advice.is_matrix ? "they are" : "they run",
                measured ? "measured here" + on_threads(advice.threads) + (predicted ? " (predicted)" : "")
                         : "predicted for " + advice.machine);
  std::string header = fmt::format("{:<14}{:>10}", "", "as it is");
  for (const Candidate& candidate : advice.candidates)
    header += fmt::format("{:>32}", methods_of(candidate, advice.is_matrix));
  console.print("{}", header);
  for (std::size_t k = 0; k < kernels_of(advice).size(); ++k) {
    std::string row = fmt::format("{:<14}{:>10}", advice.is_matrix ? kProduct : kKernelTitles[k],
                                  duration(1e-3 * known_ms(advice, k)));
    for (const Candidate& candidate : advice.candidates) {
      const std::string of_model = factor_cell(predicted_gain(advice, candidate, k));
      const std::string of_clock = factor_cell(measured_gain(advice, candidate, k));
      row += fmt::format("{:>32}", predicted && measured ? fmt::format("{} ({})", of_clock, of_model)
                                   : measured            ? of_clock
                                                         : of_model);
    }
    console.print("{}", row);
  }
  for (std::size_t i = 0; i < advice.candidates.size(); ++i) {
    const Candidate& candidate = advice.candidates[i];
    console.print("{}: `{}`, {}, {}", methods_of(candidate, advice.is_matrix),
                  command_for(candidate, advice.is_matrix), duration(candidate.order_seconds),
                  pays_in_words(advice, i));
  }
  if (!advice.is_matrix) {
    console.print("A time step here: one run of element force and of assembly, {} runs of SpMV",
                  kRunsInTimeStep[0]);
  }
}

nlohmann::ordered_json grade_json(const Advice& advice, Index vertices) {
  const Quality& ordered = advice.candidates.front().spans;
  return {{"grade", to_string(grade_of(advice.as_is.spans, ordered, vertices))},
          {"mean_span", advice.as_is.spans.mean_span},
          {"ordered", ordered.mean_span},
          {"random", (vertices + 1) / 3.0}};
}

nlohmann::ordered_json interval_json(const TimeRatio& ratio) {
  return std::isinf(ratio.high) ? nlohmann::ordered_json(nullptr)
                                : nlohmann::ordered_json{ratio.low, ratio.high};
}

nlohmann::ordered_json to_json(const Advice& advice) {
  nlohmann::ordered_json kernels;
  nlohmann::ordered_json time_step;
  const std::size_t count = kernels_of(advice).size();
  for (std::size_t k = 0; k < count; ++k) {
    const KernelAdvice& of_kernel = advice.kernels[k];
    const bool gains = of_kernel.gain.ratio > 1;
    kernels[std::string(to_string(kKernels[k]))] = {
        {"factor", gains ? nlohmann::ordered_json(of_kernel.gain.ratio) : nullptr},
        {"interval", gains ? interval_json(of_kernel.gain) : nullptr},
        {"order", gains ? nlohmann::ordered_json(of_kernel.candidate) : nullptr},
        {"runs_to_pay", gains ? nlohmann::ordered_json(of_kernel.runs_to_pay) : nullptr}};
    time_step[std::string(to_string(kKernels[k]))] = runs_in_time_step(advice, k);
  }
  auto orders = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < advice.candidates.size(); ++i) {
    const Candidate& candidate = advice.candidates[i];
    const double steps = steps_to_pay(advice, i);
    nlohmann::ordered_json order{{"command", command_for(candidate, advice.is_matrix)},
                                 {"vertices", candidate.vertices.name},
                                 {"elements", candidate.elements.name},
                                 {"seconds", candidate.order_seconds},
                                 {"time_steps_to_pay", steps > 0 ? nlohmann::ordered_json(steps) : nullptr}};
    order.update(costs_json(candidate.costs, count));
    orders.push_back(order);
  }
  return {{"sentence", to_string(advice)},
          {"by", is_measured(advice)            ? "measurement"
                 : advice.as_is.costs.predicted ? "prediction"
                                                : "nothing"},
          {"reliable", advice.doubt.empty()},
          {"doubt", or_null(advice.doubt)},
          {"machine", or_null(advice.machine)},
          {"kernel_set", to_string(advice.kernel_set)},
          {"threads", advice.threads},
          {"kernels", kernels},
          {"as_it_is", costs_json(advice.as_is.costs, count)},
          {"orders", orders},
          {"time_step", time_step}};
}

}  // namespace meshorder::command
