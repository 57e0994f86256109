// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "try_report.hpp"

#include "base/median.hpp"
#include "payoff/quantities.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

/// Returns the number of runs after which the order has saved its cost; nothing if it saves no seconds.
std::optional<double> runs_to_pay(const TrialReport& report, std::size_t order) {
  if (!is_in_seconds(report) || !is_faster(report)) return std::nullopt;
  const double gain = median(report.orders[0].times) * (1 - 1 / report.trials.speedup(order).ratio);
  return std::max(1.0, std::ceil(report.orders[order].order_seconds / gain));
}

/// Returns "1.12", near 1 "1.003".
std::string number(double ratio) {
  constexpr double kNear = 0.05;
  return std::abs(ratio - 1) < kNear ? fmt::format("{:.3f}", ratio) : fmt::format("{:.2f}", ratio);
}

/// Returns "1.08–1.16", or "" if too few pairs were run.
std::string interval(const TimeRatio& speedup) {
  return std::isinf(speedup.high) ? "" : number(speedup.low) + "–" + number(speedup.high);
}

/// Returns "rcm, 1.02× (0.97–1.07)".
std::string with_ratio(const TrialReport& report, std::size_t order) {
  const TimeRatio speedup = report.trials.speedup(order);
  const std::string range = interval(speedup);
  return fmt::format("{}, {}×{}", report.orders[order].name, number(speedup.ratio),
                     range.empty() ? range : " (" + range + ")");
}

constexpr int kBarWidth = 24;

/// Returns a time in seconds, or a number that the program printed.
std::string time_cell(const TrialReport& report, double time) {
  return is_in_seconds(report) ? duration(time) : fmt::format("{:.4g}", time);
}

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
  if (!order.times.empty()) result["time"] = median(order.times);
  if (order.count >= 0) result["count"] = order.count;
  if (!order.fault.empty()) result["fault"] = order.fault;
  const TimeRatio speedup = number == 0 ? TimeRatio{1, 1, 1} : report.trials.speedup(number);
  if (!order.times.empty()) result["ratio"] = speedup.ratio;
  if (!order.times.empty() && !std::isinf(speedup.high)) result["interval"] = {speedup.low, speedup.high};
  return result;
}

std::string_view verdict_name(const TrialReport& report) {
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
  return "undecided";
}

}  // namespace

bool is_in_seconds(const TrialReport& report) { return report.time == "cpu" || report.time == "wall"; }

bool is_faster(const TrialReport& report) { return report.trials.verdict() == TrialVerdict::faster; }

std::string trial_in_words(const TrialReport& report) {
  const std::string program = fs::path(report.command.front()).filename().string();
  const std::optional<std::size_t> best = report.trials.best();
  if (!best) return fmt::format("{} has no other order to be tried in: all are its own", program);
  const std::string found = with_ratio(report, *best);
  switch (report.trials.verdict()) {
    case TrialVerdict::faster: {
      const TimeRatio speedup = report.trials.speedup(*best);
      const std::optional<double> runs = runs_to_pay(report, *best);
      return fmt::format("{} runs {}× faster ({}) in {}; `{}` makes it{}", program, number(speedup.ratio),
                         interval(speedup), report.orders[*best].name, report.orders[*best].made_by,
                         runs ? fmt::format("; pays after {:.0f} run{}", *runs, *runs == 1 ? "" : "s") : "");
    }
    case TrialVerdict::slower:
      return fmt::format("{} runs fastest in the mesh's own order; the best other one is {}", program, found);
    case TrialVerdict::tie:
      return fmt::format("no order tried makes {} faster by more than {} %; the best one is {}", program,
                         100 * kTie, found);
    case TrialVerdict::undecided:
      break;
  }
  return fmt::format("no order tried makes {} faster by more than its runs vary; the best one is {}", program,
                     found);
}

void print_trial(const Console& console, const TrialReport& report) {
  console.print("{}\n", trial_in_words(report));
  const bool has_counts = report.orders.front().count >= 0;
  console.print("{:<20} {:>9} {:>7} {:>11} {:>5}{} {:>9}", "order", "time", "ratio", "95 %", "runs",
                has_counts ? fmt::format(" {:>8}", "count") : "", "memory");
  double longest = 0;
  for (const TriedOrder& order : report.orders) longest = std::max(longest, median(order.times));
  for (std::size_t i = 0; i < report.orders.size(); ++i) {
    const TriedOrder& order = report.orders[i];
    const std::string name = order.by_auto ? order.name + " (auto)" : order.name;
    if (!order.fault.empty()) {
      console.print("{:<20} {}", name, order.fault);
    } else if (order.times.empty()) {
      console.print("{:<20} {:>9}", name, "not timed");
    } else {
      const TimeRatio speedup = i == 0 ? TimeRatio{} : report.trials.speedup(i);
      console.print("{:<20} {:>9} {:>7.3f} {:>11} {:>5}{} {:>9}  {}", name,
                    time_cell(report, median(order.times)), speedup.ratio, interval(speedup),
                    order.times.size(), has_counts ? fmt::format(" {:>8.6g}", order.count) : "",
                    memory_cell(order.peak_bytes), bar(median(order.times) / longest, kBarWidth));
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
                                {"left_out", report.left_out},
                                {"run_seconds", report.run_seconds}};
  if (!best) return result;
  result["best"] = report.orders[*best].name;
  if (is_faster(report)) result["order_command"] = report.orders[*best].made_by;
  if (const std::optional<double> runs = runs_to_pay(report, *best)) result["runs_to_pay"] = *runs;
  return result;
}

}  // namespace meshorder::command
