// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace meshorder {

/// Orders whose times differ by less than this share are ties.
inline constexpr double kTie = 0.015;

/// How many times as fast a program runs in an order as in the file's own, with an interval that holds the
/// true number in 95 of 100 trials, although it is looked at again and again.
struct TimeRatio {
  double ratio = 1;
  double low = 0;
  double high = std::numeric_limits<double>::infinity();
};

/// What a trial found of an order, against the file's own.
enum class TrialVerdict { undecided, tie, faster, slower };

/// Returns the number that a variable of Student's t distribution with that many degrees of freedom exceeds
/// with the probability `tail`, 0 < tail < 0.5.
double student_quantile(double tail, int degrees);

/// Returns the speedup from logarithms of the ratios of paired times (own order / this order), by their mean
/// without the largest and the smallest fifth (Yuen, "The two-sample trimmed t for unequal population
/// variances", 1974; here for one sample of differences). The interval is without bounds for fewer than six.
TimeRatio time_ratio_of(std::vector<double> log_ratios);

/// Decides by paired runs in which of several orders a program runs faster than in the file's own.
///
/// The program runs in rounds, once in the file's own order and once in each order that is left; the order of
/// the runs rotates. After the third round and each later one, those orders are dropped that are slower than
/// the best one by more than twice the spread of the times, and every second round half of those that are
/// left. Then the file's own order and the best one run in turns, and after 6, 7, 8, 9, 10, 12, 14 … pairs it
/// is checked whether their interval decides: all of it lies within a tie, or beyond 1 and the ratio beyond a
/// tie.
///
/// In 4,000 trials each with log-normal times, of which one in twenty is disturbed by up to a half, at most 5
/// % of the trials of five orders that are all the same found one faster or slower, at spreads up to 5 % and
/// budgets up to 120 runs. One order in five that saves 5 % was found within 40 runs in 98, 90 and 72 % of
/// the trials at spreads of 1, 1.5 and 2 %, and within 120 runs in 97 % at 2 %
/// (tests/payoff/paired_trials_test.cpp).
class PairedTrials {
 public:
  explicit PairedTrials(std::size_t candidates);

  /// Returns what is to be run next, in this order: 0 is the file's own order, i the i-th candidate. Empty
  /// when the trial has ended.
  [[nodiscard]] std::vector<std::size_t> next_round() const;

  /// Takes the times of a round, by number; those of candidates that did not run are ignored.
  void add_round(std::span<const double> times);

  /// Takes a candidate out, 1 or more, as it does not run.
  void exclude(std::size_t candidate);

  /// Returns the best candidate so far: the only one that is left, or the one with the best median.
  /// Nothing if all are excluded.
  [[nodiscard]] std::optional<std::size_t> best() const;

  /// Returns what the best candidate is worth; undecided before one is left and checked.
  [[nodiscard]] TrialVerdict verdict() const { return verdict_; }

  [[nodiscard]] TimeRatio speedup(std::size_t candidate) const;
  /// Returns the number of pairs with the file's own order.
  [[nodiscard]] std::size_t pairs(std::size_t candidate) const { return logs_[candidate].size(); }

 private:
  void drop_losers();
  void check();

  std::vector<std::vector<double>> logs_;  ///< by number; of 0 none
  std::vector<std::size_t> left_;          ///< candidates, the best first
  std::size_t rounds_ = 0;
  std::size_t next_check_;
  TrialVerdict verdict_ = TrialVerdict::undecided;
};

}  // namespace meshorder
