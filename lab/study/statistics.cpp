// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/statistics.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

constexpr double kConfidence = 0.95;
/// Whole runs differ if their sums' variance is more than this times the variance that turns explain.
constexpr double kRunsDiffer = 3.0;

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

double mean(const std::vector<double>& values) { return sum(values) / static_cast<double>(values.size()); }

/// Returns the variance of a sample; 0 for one value.
double variance(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double middle = mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  return squares / static_cast<double>(values.size() - 1);
}

void expect_same_length(const std::vector<RunRecord>& runs, std::size_t steps) {
  for (const RunRecord& run : runs) {
    if (run.step_seconds.size() != steps) throw InvalidArgument("statistics: runs of different length");
  }
}

/// Returns the seconds of each turn of a run.
std::vector<double> turns_of(const RunRecord& run, Index turn) {
  std::vector<double> turns;
  for (std::size_t step = 0; step < run.step_seconds.size(); ++step) {
    if (step % static_cast<std::size_t>(turn) == 0) turns.push_back(0);
    turns.back() += run.step_seconds[step];
  }
  return turns;
}

/// Returns, for each index, the values of all lists at this index. The lists must have the same length.
std::vector<std::vector<double>> transposed(const std::vector<std::vector<double>>& lists) {
  std::vector<std::vector<double>> result(lists.front().size());
  for (const std::vector<double>& list : lists) {
    for (std::size_t i = 0; i < list.size(); ++i) result[i].push_back(list[i]);
  }
  return result;
}

std::vector<double> differences(const std::vector<double>& from, const std::vector<double>& subtracted) {
  std::vector<double> result(from);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] -= subtracted[i];
  return result;
}

/// Returns half the interval's width in seconds, from the seconds that two or more runs save in each turn.
double half_width_of_runs(const std::vector<std::vector<double>>& saved_by_run) {
  const auto runs = static_cast<double>(saved_by_run.size());
  double of_turns = 0;
  for (const std::vector<double>& saved : transposed(saved_by_run)) of_turns += variance(saved);
  std::vector<double> sums;
  sums.reserve(saved_by_run.size());
  for (const std::vector<double>& saved : saved_by_run) sums.push_back(sum(saved));
  const double of_sums = variance(sums);
  const Index more_runs = index_size(saved_by_run) - 1;
  if (of_sums > kRunsDiffer * of_turns) return student_t(more_runs, kConfidence) * std::sqrt(of_sums / runs);
  return student_t(index_size(saved_by_run.front()) * more_runs, kConfidence) * std::sqrt(of_turns / runs);
}

/// Returns half the interval's width in seconds for one run, from the seconds of its turns in both orders.
double half_width_of_ratio(const std::vector<double>& turns, const std::vector<double>& reference) {
  const double ratio = sum(turns) / sum(reference);
  double squares = 0;
  for (std::size_t b = 0; b < turns.size(); ++b) {
    const double residual = turns[b] - ratio * reference[b];
    squares += residual * residual;
  }
  const auto count = static_cast<double>(turns.size());
  return student_t(index_size(turns) - 1, kConfidence) * std::sqrt(count * squares / (count - 1));
}

std::vector<double> mean_steps(const std::vector<RunRecord>& runs) {
  std::vector<double> means(runs.front().step_seconds.size(), 0);
  for (const RunRecord& run : runs) {
    for (std::size_t step = 0; step < means.size(); ++step)
      means[step] += run.step_seconds[step] / static_cast<double>(runs.size());
  }
  return means;
}

std::optional<Index> break_even_step(const std::vector<double>& saved_by_step, double order_seconds) {
  double saved = 0;
  for (std::size_t step = 0; step < saved_by_step.size(); ++step) {
    saved += saved_by_step[step];
    if (saved >= order_seconds) return static_cast<Index>(step + 1);
  }
  return std::nullopt;
}

/// Returns the seconds that an order of that mesh costs; infinite if they are not known.
double order_seconds(const StudyResults& results, const std::string& mesh, const std::string& ordering) {
  const MeshRecord* const record = find_named(results.meshes, mesh);
  const MeshOrderRecord* const order = record == nullptr ? nullptr : find_order(*record, ordering);
  return order == nullptr ? std::numeric_limits<double>::infinity() : order->seconds;
}

void summarise(const StudyResults& results, ScenarioRecord& scenario) {
  for (ScenarioOrderRecord& order : scenario.orders) {
    order.time = summary_of(order.runs);
    order.speedup = {};
  }
  const ScenarioOrderRecord* const found = find_order(scenario, results.reference);
  if (found == nullptr) return;
  for (ScenarioOrderRecord& order : scenario.orders) {
    const auto runs = static_cast<std::ptrdiff_t>(std::min(order.runs.size(), found->runs.size()));
    if (order.ordering == results.reference || runs == 0) continue;
    order.speedup = speedup_of({order.runs.begin(), order.runs.begin() + runs},
                               {found->runs.begin(), found->runs.begin() + runs}, scenario.turn,
                               scenario.method == "particle-fem"  // its steps contain the order
                                   ? 0
                                   : order_seconds(results, scenario.mesh, order.ordering));
  }
}

/// Returns the probability of |t| ≤ √degrees · tan angle.
double probability_within(double angle, Index degrees) {
  const bool odd = degrees % 2 == 1;
  const double cosine = std::cos(angle);
  double term = odd ? cosine : 1.0;
  double sum = degrees == 1 ? 0.0 : term;
  for (Index power = odd ? 3 : 2; power <= degrees - 2; power += 2) {
    term *= cosine * cosine * (power - 1) / power;
    sum += term;
  }
  const double series = std::sin(angle) * sum;
  return odd ? 2.0 / std::numbers::pi * (angle + series) : series;
}

}  // namespace

TimeSummary summary_of(const std::vector<RunRecord>& runs) {
  if (runs.empty()) return {};
  expect_same_length(runs, runs.front().step_seconds.size());
  std::vector<double> sums;
  std::vector<double> fastest = runs.front().step_seconds;
  for (const RunRecord& run : runs) {
    sums.push_back(sum(run.step_seconds));
    for (std::size_t step = 0; step < fastest.size(); ++step)
      fastest[step] = std::min(fastest[step], run.step_seconds[step]);
  }
  return {.mean = mean(sums), .deviation = std::sqrt(variance(sums)), .undisturbed = sum(fastest)};
}

Speedup speedup_of(const std::vector<RunRecord>& runs, const std::vector<RunRecord>& reference, Index turn,
                   double order_seconds) {
  if (turn < 1) throw InvalidArgument("statistics: turns of no steps");
  if (runs.empty() || runs.size() != reference.size())
    throw InvalidArgument("statistics: as many runs of an order as of the reference are needed");
  const std::size_t steps = runs.front().step_seconds.size();
  expect_same_length(runs, steps);
  expect_same_length(reference, steps);
  const TimeSummary time = summary_of(runs);
  const TimeSummary of_reference = summary_of(reference);
  Speedup speedup;
  speedup.saved_seconds = of_reference.mean - time.mean;
  speedup.break_even_step =
      break_even_step(differences(mean_steps(reference), mean_steps(runs)), order_seconds);
  if (!(of_reference.mean > 0.0)) return speedup;

  std::vector<std::vector<double>> saved;
  for (std::size_t r = 0; r < runs.size(); ++r)
    saved.push_back(differences(turns_of(reference[r], turn), turns_of(runs[r], turn)));
  const bool has_interval = runs.size() > 1 || saved.front().size() > 1;
  double half_width = 0;
  if (runs.size() > 1) {
    half_width = half_width_of_runs(saved);
  } else if (has_interval) {
    half_width = half_width_of_ratio(turns_of(runs.front(), turn), turns_of(reference.front(), turn));
  }
  const double per_second = 100.0 / of_reference.mean;
  speedup.percent = per_second * speedup.saved_seconds;
  speedup.low = speedup.percent - per_second * half_width;
  speedup.high = speedup.percent + per_second * half_width;
  speedup.beyond_noise = has_interval && (speedup.low > 0.0 || speedup.high < 0.0);
  if (of_reference.undisturbed > 0.0)
    speedup.undisturbed_percent = 100.0 * (1.0 - time.undisturbed / of_reference.undisturbed);
  return speedup;
}

void summarise(StudyResults& results) {
  for (ScenarioRecord& scenario : results.scenarios) summarise(std::as_const(results), scenario);
}

double student_t(Index degrees, double probability) {
  if (degrees < 1) throw InvalidArgument("student_t: less than one degree of freedom");
  if (!(probability > 0.0 && probability < 1.0))
    throw InvalidArgument("student_t: a probability that is not between 0 and 1");
  double low = 0.0;
  double high = std::numbers::pi / 2;
  constexpr int kBitsOfDouble = 53;
  for (int i = 0; i < kBitsOfDouble; ++i) {
    const double middle = 0.5 * (low + high);
    (probability_within(middle, degrees) < probability ? low : high) = middle;
  }
  return std::sqrt(degrees) * std::tan(0.5 * (low + high));
}

}  // namespace meshorder
