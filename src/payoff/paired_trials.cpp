// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/paired_trials.hpp"

#include "base/median.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace meshorder {
namespace {

constexpr std::size_t kFewestRounds = 3;  // rounds before the first drop: a median of 3 ignores an outlier
constexpr std::size_t kFewestPairs = 6;   // pairs before a mean is trimmed
constexpr std::size_t kFirstCheck = 4;    // pairs before an interval decides
constexpr double kPlainlySlower = 1.2;
constexpr double kTail = 0.003;  // probability on each side of the interval of a single check
constexpr double kTrimmed = 0.2;
constexpr double kBetweenChecks = 1.2;
constexpr double kLeastSpread = 0.003;
constexpr double kLeastDistance = 0.001;  // least distance of an interval from 1: reports show three decimals

/// Returns the probability that Student's t exceeds `t` > 0, by the finite series of Abramowitz and Stegun,
/// "Handbook of Mathematical Functions", 1964, 26.7.3 and 26.7.4.
double student_tail(double t, int degrees) {
  const double angle = std::atan(t / std::sqrt(degrees));
  const double cosine = std::cos(angle);
  const bool is_odd = degrees % 2 == 1;
  double term = is_odd ? cosine : 1;
  double sum = degrees == 1 ? 0 : term;
  for (int k = is_odd ? 3 : 2; k < degrees - 1; k += 2) {
    term *= cosine * cosine * (k - 1) / k;
    sum += term;
  }
  const double within =
      is_odd ? 2 / std::numbers::pi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
  return (1 - within) / 2;
}

/// Returns a robust standard deviation, which a few outliers hardly change: the scaled median of the values'
/// distances from their median.
double spread(const std::vector<double>& values) {
  constexpr double kOfNormal = 1.4826;
  const double middle = median(values);
  std::vector<double> distances;
  distances.reserve(values.size());
  for (const double value : values) distances.push_back(std::abs(value - middle));
  return kOfNormal * median(distances);
}

/// Returns the ratio for fewer than six pairs. The control has the same spread, with a mean of 0.
TimeRatio ratio_of_few(const std::vector<double>& log_ratios, const std::vector<double>& control) {
  const auto n = static_cast<double>(log_ratios.size());
  const double mean = std::accumulate(log_ratios.begin(), log_ratios.end(), 0.0) / n;
  if (log_ratios.size() < 2) return {.ratio = std::exp(mean)};
  double squares = 0;
  for (const double log : log_ratios) squares += (log - mean) * (log - mean);
  for (const double log : control) squares += log * log;
  const std::size_t degrees = log_ratios.size() - 1 + control.size();
  const double deviation = std::max(std::sqrt(squares / static_cast<double>(degrees)), kLeastSpread);
  const double width = student_quantile(kTail, static_cast<int>(degrees)) * deviation / std::sqrt(n);
  return {.ratio = std::exp(mean), .low = std::exp(mean - width), .high = std::exp(mean + width)};
}

}  // namespace

double student_quantile(double tail, int degrees) {
  double low = 0;
  double high = 1;
  while (student_tail(high, degrees) > tail) high *= 2;
  constexpr int kSteps = 60;
  for (int step = 0; step < kSteps; ++step) {
    const double middle = (low + high) / 2;
    (student_tail(middle, degrees) > tail ? low : high) = middle;
  }
  return (low + high) / 2;
}

bool is_reportable(const TimeRatio& speedup) {
  const bool is_tie = speedup.low > 1 / (1 + kTie) && speedup.high < 1 + kTie;
  return speedup.low > 1 || speedup.high < 1 || is_tie;
}

TimeRatio time_ratio_of(std::vector<double> log_ratios, const std::vector<double>& control) {
  if (log_ratios.empty()) return {};
  if (log_ratios.size() < kFewestPairs) return ratio_of_few(log_ratios, control);
  std::sort(log_ratios.begin(), log_ratios.end());
  const auto cut = static_cast<std::ptrdiff_t>(kTrimmed * static_cast<double>(log_ratios.size()));
  const auto first = log_ratios.begin() + cut;
  const auto last = log_ratios.end() - cut;
  const auto kept = static_cast<double>(last - first);
  const double mean = std::accumulate(first, last, 0.0) / kept;
  std::fill(log_ratios.begin(), first, *first);  // winsorise: the variance is computed from clamped values
  std::fill(last, log_ratios.end(), *(last - 1));
  const double middle =
      std::accumulate(log_ratios.begin(), log_ratios.end(), 0.0) / static_cast<double>(log_ratios.size());
  double squares = 0;
  for (const double log : log_ratios) squares += (log - middle) * (log - middle);
  const double width =
      student_quantile(kTail, static_cast<int>(kept) - 1) * std::sqrt(squares / (kept * (kept - 1)));
  return {.ratio = std::exp(mean), .low = std::exp(mean - width), .high = std::exp(mean + width)};
}

PairedTrials::PairedTrials(std::size_t candidates)
    : logs_(candidates + 1), left_(candidates), next_check_(kFirstCheck) {
  std::iota(left_.begin(), left_.end(), std::size_t{1});
}

std::vector<std::size_t> PairedTrials::next_round() const {
  if (left_.empty() || verdict_ != TrialVerdict::undecided) return {};
  std::vector<std::size_t> round{0};
  round.insert(round.end(), left_.begin(), left_.end());
  const auto start = static_cast<std::ptrdiff_t>(rounds_ % round.size());
  std::rotate(round.begin(), round.begin() + start, round.end());
  return round;
}

void PairedTrials::add_round(std::span<const double> times) {
  for (const std::size_t candidate : left_) logs_[candidate].push_back(std::log(times[0] / times[candidate]));
  own_times_.push_back(times[0]);
  ++rounds_;
  if (rounds_ % 2 == 0) control_.push_back(std::log(own_times_[rounds_ - 2] / own_times_[rounds_ - 1]));
  if (rounds_ == 2) drop_plainly_slower();
  if (left_.size() > 1 && rounds_ >= kFewestRounds) drop_losers();
  if (left_.size() == 1) check();
}

void PairedTrials::exclude(std::size_t candidate) { std::erase(left_, candidate); }

std::optional<std::size_t> PairedTrials::best() const {
  if (left_.empty()) return std::nullopt;
  return *std::max_element(left_.begin(), left_.end(),
                           [&](std::size_t a, std::size_t b) { return median(logs_[a]) < median(logs_[b]); });
}

TimeRatio PairedTrials::speedup(std::size_t candidate) const {
  return time_ratio_of(logs_[candidate], control_);
}

TimeRatio PairedTrials::control() const {
  if (control_.empty()) return {};
  const auto [low, high] = std::ranges::minmax(control_);
  return {.ratio = std::exp(median(control_)), .low = std::exp(low), .high = std::exp(high)};
}

void PairedTrials::drop_plainly_slower() {
  double best = -std::numeric_limits<double>::infinity();
  for (const std::size_t candidate : left_) best = std::max(best, std::ranges::min(logs_[candidate]));
  std::erase_if(left_, [&](std::size_t candidate) {
    return std::ranges::max(logs_[candidate]) < best - std::log(kPlainlySlower);
  });
}

void PairedTrials::drop_losers() {
  std::stable_sort(left_.begin(), left_.end(),
                   [&](std::size_t a, std::size_t b) { return median(logs_[a]) > median(logs_[b]); });
  const std::vector<double>& best = logs_[left_.front()];
  std::vector<double> spreads;  // spreads of the differences between an order and the best one
  for (const std::size_t candidate : left_) {
    if (candidate == left_.front()) continue;
    std::vector<double> differences;
    for (std::size_t i = 0; i < best.size(); ++i) differences.push_back(best[i] - logs_[candidate][i]);
    spreads.push_back(spread(differences));
  }
  const auto rounds = static_cast<double>(best.size());
  const double error =
      std::max(median(spreads) * std::sqrt(rounds / (rounds - 1)), kLeastSpread) / std::sqrt(rounds);
  const double least = median(best) - 2 * error;
  std::erase_if(left_, [&](std::size_t candidate) { return median(logs_[candidate]) < least; });
  const std::size_t most = std::max<std::size_t>(1, (logs_.size() - 1) >> (rounds_ / 2));
  if (left_.size() > most) left_.resize(most);
}

void PairedTrials::check() {
  const std::size_t pairs = logs_[left_.front()].size();
  if (pairs < next_check_) return;
  while (next_check_ <= pairs)
    next_check_ = std::max(next_check_ + 1,
                           static_cast<std::size_t>(kBetweenChecks * static_cast<double>(next_check_)));
  const TimeRatio found = speedup(left_.front());
  if (found.low > 1 / (1 + kTie) && found.high < 1 + kTie) {
    verdict_ = TrialVerdict::tie;
  } else if (found.low >= 1 + kLeastDistance && found.ratio > 1 + kTie) {
    verdict_ = TrialVerdict::faster;
  } else if (found.high <= 1 - kLeastDistance && found.ratio < 1 / (1 + kTie)) {
    verdict_ = TrialVerdict::slower;
  }
}

}  // namespace meshorder
