// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/payoff.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace meshorder {

/// Orders whose times differ by less than this share are ties.
inline constexpr double kTie = 0.015;

/// The words for two orders whose times do not differ by more than the noise.
inline constexpr std::string_view kNotToldApart = "not told apart";

/// The result of a trial of an order against the file's own.
enum class TrialVerdict { undecided, tie, faster, slower };

/// Returns the quantile of Student's t distribution with that many degrees of freedom: a variable exceeds it
/// with probability `tail`, 0 < tail < 0.5.
double student_quantile(double tail, int degrees);

/// Returns whether a ratio may be reported: its interval does not contain 1, or is so narrow that the orders
/// are ties. Else they are "not told apart", and only the interval may be reported.
[[nodiscard]] bool is_reportable(const TimeRatio& speedup);

/// Returns the speedup from logarithms of the ratios of paired times (own order / this order): their mean
/// without the largest and the smallest fifth (Yuen, "The two-sample trimmed t for unequal population
/// variances", 1974; here for one sample of differences). For two to five logarithms, returns their mean; the
/// interval then uses the spread of `control`, too: logarithms of ratios of runs in one order. One logarithm
/// has no interval.
TimeRatio time_ratio_of(std::vector<double> log_ratios, const std::vector<double>& control = {});

/// Decides by paired runs in which of several orders a program runs faster than in the file's own.
///
/// The program runs in rounds, once in the file's own order and once in each order that is left; the sequence
/// of the runs rotates. Round 2 drops the orders that are plainly slower: in each round, by a fifth or more
/// than the best one in any. From round 3 on, each round drops the orders that are slower than the best one
/// by more than twice the standard error. At most half of the candidates are left after round 3, a quarter
/// after round 4, an eighth after round 6 …. When only one candidate is left, the program runs in the file's
/// own order and in that candidate by turns. After 4, 5, 6, 7, 8, 9, 10, 12, 14 … pairs of runs, the interval
/// of the ratio is checked. The trial ends if the whole interval is within a tie, or if it is at least 0.001
/// away from 1 and the ratio is not a tie.
///
/// This was tested by simulated trials, 4,000 of each kind (tests/payoff/paired_trials_test.cpp). Times were
/// log-normal, and one in twenty was longer by up to a half.
/// - With five equal orders, spreads up to 5 % and budgets up to 120 runs, at most 5 % of the trials found an
///   order faster or slower.
/// - With one order of five that saves 5 %, 98, 90 and 72 % of the trials found it within 40 runs at spreads
///   of 1, 1.5 and 2 %; within 120 runs, 97 % found it at a spread of 2 %.
class PairedTrials {
 public:
  explicit PairedTrials(std::size_t candidates);

  /// Returns the orders to run next, in sequence: 0 is the file's own order, i the i-th candidate. Empty if
  /// the trial has ended.
  [[nodiscard]] std::vector<std::size_t> next_round() const;

  /// Adds the times of a round, indexed as in next_round; times of candidates that did not run are ignored.
  void add_round(std::span<const double> times);

  /// Excludes a candidate (≥ 1) that cannot run.
  void exclude(std::size_t candidate);

  /// Returns the best candidate so far: the only one that is left, or the one with the best median. Nothing
  /// if all candidates are excluded.
  [[nodiscard]] std::optional<std::size_t> best() const;

  /// Returns the verdict on the best candidate; undecided until no other candidate is left and the interval
  /// decides.
  [[nodiscard]] TrialVerdict verdict() const { return verdict_; }

  /// Returns the speedup of a candidate (≥ 1).
  [[nodiscard]] TimeRatio speedup(std::size_t candidate) const;
  /// Returns the median, the smallest and the largest ratio of the file's own order to itself, in rounds 1
  /// and 2, 3 and 4 …. What they differ from 1 is noise. `high` is infinite before round 2.
  [[nodiscard]] TimeRatio control() const;
  /// Returns how many pairs the candidate has with the file's own order.
  [[nodiscard]] std::size_t pairs(std::size_t candidate) const { return logs_[candidate].size(); }

 private:
  void drop_plainly_slower();
  void drop_losers();
  void check();

  std::vector<double> own_times_;
  std::vector<double> control_;            ///< logarithms of ratios of own_times_ in successive rounds
  std::vector<std::vector<double>> logs_;  ///< logarithms of time ratios, by candidate; logs_[0] is empty
  std::vector<std::size_t> left_;          ///< candidates, the best first
  std::size_t rounds_ = 0;
  std::size_t next_check_;
  TrialVerdict verdict_ = TrialVerdict::undecided;
};

}  // namespace meshorder
