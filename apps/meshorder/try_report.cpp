// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "try_report.hpp"

#include "base/median.hpp"
#include "payoff/quantities.hpp"
#include "try_finding.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace meshorder::command {
namespace {

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
  if (!order.times.empty()) result["time"] = time_of(report, number);
  if (order.count >= 0) result["count"] = order.count;
  if (!order.fault.empty()) result["fault"] = order.fault;
  const TimeRatio speedup = number == 0 ? TimeRatio{1, 1, 1} : report.trials.speedup(number);
  if (!order.times.empty()) result["ratio"] = speedup.ratio;
  if (!order.times.empty() && !std::isinf(speedup.high)) result["interval"] = {speedup.low, speedup.high};
  return result;
}

}  // namespace

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
  double longest = 0;
  for (std::size_t i = 0; i < report.orders.size(); ++i) {
    if (!report.orders[i].times.empty()) longest = std::max(longest, time_of(report, i));
  }
  for (std::size_t i = 0; i < report.orders.size(); ++i) {
    const TriedOrder& order = report.orders[i];
    const std::string name = order.by_auto ? order.name + " (auto)" : order.name;
    if (!order.fault.empty()) {
      console.print("{:<20} {}", name, order.fault);
    } else if (order.times.empty()) {
      console.print("{:<20} {:>9}", name, "not timed");
    } else {
      const TimeRatio speedup = i == 0 ? TimeRatio{} : report.trials.speedup(i);
      console.print("{:<20} {:>9} {:>7.3f} {:>11} {:>5}{} {:>9}  {}", name, time_in_words(report, i),
                    speedup.ratio, interval_in_words(speedup), order.times.size(),
                    has_counts ? fmt::format(" {:>8.6g}", order.count) : "", memory_cell(order.peak_bytes),
                    bar(time_of(report, i) / longest, kBarWidth));
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
                                {"needed_budget", nullptr},
                                {"run_seconds", report.run_seconds}};
  if (const std::optional<double> budget = needed_budget(report)) result["needed_budget"] = *budget;
  if (!best) return result;
  result["best"] = report.orders[*best].name;
  if (is_faster(report)) result["order_command"] = report.orders[*best].made_by;
  if (const std::optional<double> runs = runs_to_pay(report)) result["runs_to_pay"] = *runs;
  return result;
}

}  // namespace meshorder::command
