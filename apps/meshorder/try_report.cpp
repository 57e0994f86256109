// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "try_report.hpp"

#include "base/median.hpp"
#include "payoff/quantities.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

namespace meshorder::command {
namespace {

/// Returns "1.12", near 1 "1.003".
std::string ratio_in_words(double ratio) {
  constexpr double kNear = 0.05;
  return std::abs(ratio - 1) < kNear ? fmt::format("{:.3f}", ratio) : fmt::format("{:.2f}", ratio);
}

namespace fs = std::filesystem;

// expected number of runs: of the best order (a first run, the rounds of selection, the compared pairs), and
// of each other order
constexpr double kRunsOfBest = 15;
constexpr double kRunsOfEach = 3;

bool is_interpreter(std::string_view name) {
  constexpr std::array kBeginnings{"python", "perl", "ruby", "julia", "octave", "node", "Rscript"};
  constexpr std::array kShells{"sh", "bash", "dash", "zsh", "ksh"};
  return std::ranges::any_of(kBeginnings, [&](std::string_view word) { return name.starts_with(word); }) ||
         std::ranges::find(kShells, name) != kShells.end();
}

/// Returns a number of seconds rounded up to two digits.
double rounded_up(double seconds) {
  const double scale = std::pow(10, 1 - std::floor(std::log10(seconds)));
  return std::ceil(seconds * scale) / scale;
}

/// Returns "in rcm it is 1.02× as fast (0.97–1.07)".
std::string nearest_in_words(const TrialReport& report, std::size_t order) {
  const TimeRatio speedup = report.trials.speedup(order);
  return fmt::format("in {} it is {}× as fast ({})", report.orders[order].name, ratio_in_words(speedup.ratio),
                     interval_in_words(speedup));
}

std::string undecided_in_words(const TrialReport& report, std::size_t best) {
  const std::string program = program_name(report.command);
  const double budget = needed_budget(report).value_or(report.budget_seconds);
  const TimeRatio speedup = report.trials.speedup(best);
  if (interval_in_words(speedup).empty())
    return fmt::format("undecided: too few runs of {} to say; raise --budget to {:.6g} s", program, budget);
  if (!is_reportable(speedup)) {
    return fmt::format(
        "{}: the runs of {} vary too much; {} makes it {}× as fast, and --budget {:.6g} halves this range",
        kNotToldApart, program, report.orders[best].name, interval_in_words(speedup), budget);
  }
  return fmt::format("undecided: {} so far, and --budget {:.6g} halves the range",
                     nearest_in_words(report, best), budget);
}

constexpr int kBarWidth = 24;

std::string memory_cell(std::int64_t bytes) {
  constexpr double kMega = 1e6;
  return fmt::format("{:.3g} MB", static_cast<double>(bytes) / kMega);
}

nlohmann::ordered_json order_json(const TrialReport& report, std::size_t number) {
  const TriedOrder& order = report.orders[number];
  nlohmann::ordered_json result{{"name", order.name},
                                {"vertices", order.methods.vertices},
                                {"elements", order.methods.elements},
                                {"by_auto", order.by_auto},
                                {"time", nullptr},
                                {"ratio", nullptr},
                                {"interval", nullptr},
                                {"runs", order.times.size()},
                                {"count", nullptr},
                                {"peak_bytes", order.peak_bytes},
                                {"order_seconds", order.order_seconds},
                                {"fault", nullptr}};
  if (order.count >= 0) result["count"] = order.count;
  if (!order.fault.empty()) result["fault"] = order.fault;
  const TimeRatio speedup = number == 0 ? TimeRatio{1, 1, 1} : report.trials.speedup(number);
  if (!order.times.empty() && is_reportable(speedup)) {
    result["time"] = time_of(report, number);
    result["ratio"] = speedup.ratio;
  }
  if (!order.times.empty() && !std::isinf(speedup.high)) result["interval"] = {speedup.low, speedup.high};
  return result;
}

}  // namespace

bool is_in_seconds(const TrialReport& report) { return report.time == "cpu" || report.time == "wall"; }

bool is_faster(const TrialReport& report) { return report.trials.verdict() == TrialVerdict::faster; }

std::string verdict_name(const TrialReport& report) {
  switch (report.trials.verdict()) {
    case TrialVerdict::faster:
      return "faster";
    case TrialVerdict::slower:
      return "slower";
    case TrialVerdict::tie:
      return "tie";
    case TrialVerdict::undecided:
      break;
  }
  const std::optional<std::size_t> best = report.trials.best();
  const TimeRatio speedup = best ? report.trials.speedup(*best) : TimeRatio{};
  return interval_in_words(speedup).empty() || is_reportable(speedup) ? "undecided"
                                                                      : std::string(kNotToldApart);
}

std::string known_so_far(const TrialReport& report) {
  const std::optional<std::size_t> best = report.trials.best();
  const std::string interval = best ? interval_in_words(report.trials.speedup(*best)) : "";
  return interval.empty() ? "" : report.orders[*best].name + ' ' + interval;
}

std::string program_name(const std::vector<std::string>& command) {
  std::string program = fs::path(command.front()).filename().string();
  if (!is_interpreter(program)) return program;
  for (auto word = command.begin() + 1; word != command.end(); ++word) {
    if (*word == "-c" || *word == "-e" || word->starts_with('{')) break;  // a script's text, not its name
    if (!word->empty() && !word->starts_with('-')) return fs::path(*word).filename().string();
  }
  return program;
}

std::string interval_in_words(const TimeRatio& speedup) {
  return std::isinf(speedup.high) ? "" : ratio_in_words(speedup.low) + "–" + ratio_in_words(speedup.high);
}

std::optional<double> runs_to_pay(const TrialReport& report) {
  if (!is_in_seconds(report) || !is_faster(report)) return std::nullopt;
  const std::size_t best = *report.trials.best();
  const double gain = time_of(report, 0) - time_of(report, best);
  return std::max(1.0, std::ceil(report.orders[best].order_seconds / gain));
}

std::size_t orders_that_fit(double runs) {
  constexpr double kMost = 1e6;
  return static_cast<std::size_t>(std::max(1.0, (std::min(runs, kMost) - kRunsOfBest) / kRunsOfEach));
}

std::optional<double> needed_budget(const TrialReport& report) {
  const std::optional<std::size_t> best = report.trials.best();
  if (!best || report.trials.verdict() != TrialVerdict::undecided) return std::nullopt;
  constexpr double kFourfold = 4;  // halves the interval: its width falls with the square root of the runs
  if (!std::isinf(report.trials.speedup(*best).high)) return rounded_up(kFourfold * report.budget_seconds);
  constexpr double kReserve = 1.25;
  auto others = static_cast<double>(report.left_out.size());
  double runs = 0;
  for (const TriedOrder& order : report.orders) {
    runs += 1 + static_cast<double>(order.times.size());
    if (order.fault.empty() && &order != &report.orders.front()) ++others;
  }
  const double needed = kReserve * (kRunsOfBest + kRunsOfEach * others) * report.run_seconds / runs;
  return rounded_up(std::max(needed, kReserve * report.budget_seconds));
}

std::string trial_in_words(const TrialReport& report) {
  const std::string program = program_name(report.command);
  const std::optional<std::size_t> best = report.trials.best();
  if (!best) return fmt::format("{} was not tried in another order: all are the mesh's own", program);
  switch (report.trials.verdict()) {
    case TrialVerdict::faster: {
      const TimeRatio speedup = report.trials.speedup(*best);
      const std::optional<double> runs = runs_to_pay(report);
      return fmt::format(
          "{} runs {}× faster ({}) in {}; `{}` makes it{}", program, ratio_in_words(speedup.ratio),
          interval_in_words(speedup), report.orders[*best].name, report.orders[*best].made_by,
          runs ? fmt::format("; pays off after {:.0f} run{}", *runs, *runs == 1 ? "" : "s") : "");
    }
    case TrialVerdict::slower:
      return fmt::format("slower: {} runs fastest in the mesh's own order; {}", program,
                         nearest_in_words(report, *best));
    case TrialVerdict::tie:
      return fmt::format("tie: no order tried makes {} faster by more than {} %; {}", program, 100 * kTie,
                         nearest_in_words(report, *best));
    case TrialVerdict::undecided:
      break;
  }
  return undecided_in_words(report, *best);
}

double time_of(const TrialReport& report, std::size_t order) {
  const double own = median(report.orders.front().times);
  return order == 0 ? own : own / report.trials.speedup(order).ratio;
}

std::string time_in_words(const TrialReport& report, std::size_t order) {
  const double time = time_of(report, order);
  return is_in_seconds(report) ? duration(time) : fmt::format("{:.4g}", time);
}

void print_trial(const Console& console, const TrialReport& report) {
  console.print("{}\n", trial_in_words(report));
  const bool has_counts = report.orders.front().count >= 0;
  console.print("{:<20} {:>9} {:>7} {:>11} {:>5}{} {:>9}", "order", "time", "ratio", "95 %", "runs",
                has_counts ? fmt::format(" {:>8}", "count") : "", "memory");
  const auto is_known = [&](std::size_t i) {
    return !report.orders[i].times.empty() && (i == 0 || is_reportable(report.trials.speedup(i)));
  };
  double longest = 0;
  for (std::size_t i = 0; i < report.orders.size(); ++i) {
    if (is_known(i)) longest = std::max(longest, time_of(report, i));
  }
  for (std::size_t i = 0; i < report.orders.size(); ++i) {
    const TriedOrder& order = report.orders[i];
    if (const TimeRatio control = report.trials.control(); i == 1 && !std::isinf(control.high))
      console.print("{:<20} {:>9} {:>7} {:>11}", "original again", "", "", interval_in_words(control));
    const std::string name = order.by_auto ? order.name + " (auto)" : order.name;
    if (!order.fault.empty()) {
      console.print("{:<20} {}", name, order.fault);
    } else if (order.times.empty()) {
      console.print("{:<20} {:>9}", name, "not timed");
    } else {
      const TimeRatio speedup = i == 0 ? TimeRatio{} : report.trials.speedup(i);
      console.print("{:<20} {:>9} {:>7} {:>11} {:>5}{} {:>9}  {}", name,
                    is_known(i) ? time_in_words(report, i) : "",
                    is_known(i) ? fmt::format("{:.3f}", speedup.ratio) : "", interval_in_words(speedup),
                    order.times.size(), has_counts ? fmt::format(" {:>8.6g}", order.count) : "",
                    memory_cell(order.peak_bytes),
                    is_known(i) ? bar(time_of(report, i) / longest, kBarWidth) : kNotToldApart);
    }
  }
}

nlohmann::ordered_json to_json(const TrialReport& report) {
  auto orders = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < report.orders.size(); ++i) orders.push_back(order_json(report, i));
  const std::optional<std::size_t> best = report.trials.best();
  nlohmann::ordered_json result{{"command", report.command},
                                {"time", report.time},
                                {"finding", trial_in_words(report)},
                                {"verdict", verdict_name(report)},
                                {"best", nullptr},
                                {"order_command", nullptr},
                                {"runs_to_pay", nullptr},
                                {"tie", kTie},
                                {"orders", orders},
                                {"control", nullptr},
                                {"left_out", report.left_out},
                                {"needed_budget", nullptr},
                                {"run_seconds", report.run_seconds}};
  if (const std::optional<double> budget = needed_budget(report)) result["needed_budget"] = *budget;
  const TimeRatio control = report.trials.control();
  if (!std::isinf(control.high)) result["control"] = {control.low, control.high};
  if (!best) return result;
  result["best"] = report.orders[*best].name;
  if (is_faster(report)) result["order_command"] = report.orders[*best].made_by;
  if (const std::optional<double> runs = runs_to_pay(report)) result["runs_to_pay"] = *runs;
  return result;
}

}  // namespace meshorder::command
