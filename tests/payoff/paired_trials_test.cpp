// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/paired_trials.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace meshorder {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A program whose times vary by `spread`, and sometimes by up to a half, as on a busy machine.
class Program {
 public:
  Program(std::vector<double> seconds, double spread, unsigned seed)
      : seconds_(std::move(seconds)), spread_(spread), random_(seed) {}

  double run(std::size_t order) {
    constexpr double kDisturbed = 0.05;
    const double factor = std::exp(spread_ * normal_(random_));
    const double disturbance = uniform_(random_) < kDisturbed ? 1 + uniform_(random_) / 2 : 1;
    const double time = seconds_[order] * factor * disturbance;
    spent_ += time;
    return time;
  }

  [[nodiscard]] double spent() const { return spent_; }

 private:
  std::vector<double> seconds_;
  double spread_;
  double spent_ = 0;
  std::mt19937 random_;
  std::normal_distribution<> normal_;
  std::uniform_real_distribution<> uniform_;
};

PairedTrials trial_of(Program& program, std::size_t orders, double budget) {
  for (std::size_t order = 0; order < orders; ++order) (void)program.run(order);  // a first run of each
  PairedTrials trials(orders - 1);
  for (std::vector<std::size_t> round; !(round = trials.next_round()).empty();) {
    if (program.spent() + static_cast<double>(round.size()) > budget) break;
    std::vector<double> times(orders, 1);
    for (const std::size_t order : round) times[order] = program.run(order);
    trials.add_round(times);
  }
  return trials;
}

TEST(PairedTrials, QuantilesAreThoseOfTables) {
  EXPECT_NEAR(student_quantile(0.025, 1), 12.7062, 1e-3);
  EXPECT_NEAR(student_quantile(0.025, 2), 4.30265, 1e-4);
  EXPECT_NEAR(student_quantile(0.005, 3), 5.84091, 1e-4);
  EXPECT_NEAR(student_quantile(0.005, 10), 3.16927, 1e-4);
  EXPECT_NEAR(student_quantile(0.001, 7), 4.78529, 1e-4);
}

TEST(PairedTrials, OnePairHasNoInterval) {
  const TimeRatio speedup = time_ratio_of({std::log(2.0)});
  EXPECT_DOUBLE_EQ(speedup.ratio, 2);
  EXPECT_EQ(speedup.low, 0);
  EXPECT_TRUE(std::isinf(speedup.high));
  EXPECT_FALSE(is_reportable(speedup));
}

TEST(PairedTrials, FewPairsAreJudgedWithTheSpreadOfTheControl) {
  const std::vector<double> logs{0.10, 0.11, 0.09, 0.12};
  // as python/tests/test_try.py expects of the same rule
  const TimeRatio speedup = time_ratio_of(logs, {0.01, -0.02});
  EXPECT_NEAR(speedup.ratio, 1.1107106, 1e-6);
  EXPECT_NEAR(speedup.low, 1.0753893, 1e-6);
  EXPECT_NEAR(speedup.high, 1.1471920, 1e-6);
  EXPECT_TRUE(is_reportable(speedup));
  EXPECT_FALSE(is_reportable(time_ratio_of(logs, {0.2, -0.2})));
}

TEST(PairedTrials, OnlyNarrowIntervalsAroundOneAreTold) {
  EXPECT_TRUE(is_reportable({.ratio = 1, .low = 0.99, .high = 1.01}));
  EXPECT_FALSE(is_reportable({.ratio = 1, .low = 0.99, .high = 1.02}));
  EXPECT_TRUE(is_reportable({.ratio = 0.8, .low = 0.7, .high = 0.99}));
}

TEST(PairedTrials, TheControlComparesTheOwnOrderWithItself) {
  PairedTrials trials(1);
  EXPECT_TRUE(std::isinf(trials.control().high));
  for (const double own : {1.0, 1.0, 1.1, 1.0, 9.0}) trials.add_round(std::vector<double>{own, own});
  const TimeRatio control = trials.control();
  EXPECT_DOUBLE_EQ(control.low, 1);
  EXPECT_DOUBLE_EQ(control.high, 1.1);
}

TEST(PairedTrials, AnOutlierHardlyMovesASpeedup) {
  std::vector<double> logs{0.10, 0.11, 0.09, 0.10, 0.12, 0.08, 0.10, 0.11, 0.09, 0.10};
  const TimeRatio before = time_ratio_of(logs);
  EXPECT_NEAR(before.ratio, std::exp(0.1), 1e-3);
  logs.back() = -3;
  const TimeRatio after = time_ratio_of(logs);
  EXPECT_NEAR(after.ratio, before.ratio, 0.01);
  // as python/tests/test_try.py expects of the same rule
  EXPECT_NEAR(after.ratio, 1.1033305, 1e-6);
  EXPECT_NEAR(after.low, 1.0794101, 1e-6);
  EXPECT_NEAR(after.high, 1.1277810, 1e-6);
}

TEST(PairedTrials, OrdersTakeTurnsInEachRound) {
  PairedTrials trials(2);
  EXPECT_THAT(trials.next_round(), ElementsAre(0, 1, 2));
  trials.add_round(std::vector<double>{1, 1, 1});
  EXPECT_THAT(trials.next_round(), ElementsAre(1, 2, 0));
}

TEST(PairedTrials, LosersAreDroppedEarly) {
  PairedTrials trials(3);
  for (int round = 0; round < 2; ++round) trials.add_round(std::vector<double>{1, 0.9, 2, 1.01});
  EXPECT_THAT(trials.next_round(), testing::UnorderedElementsAre(0, 1, 3));
  trials.add_round(std::vector<double>{1, 0.9, 2, 1.01});
  EXPECT_THAT(trials.next_round(), testing::UnorderedElementsAre(0, 1));
  EXPECT_EQ(trials.pairs(2), 2);
  EXPECT_EQ(trials.best(), 1);
}

TEST(PairedTrials, ThoseThatDoNotRunAreOut) {
  PairedTrials trials(2);
  trials.exclude(1);
  EXPECT_THAT(trials.next_round(), ElementsAre(0, 2));
  trials.exclude(2);
  EXPECT_THAT(trials.next_round(), IsEmpty());
  EXPECT_FALSE(trials.best());
}

TEST(PairedTrials, SteadyTimesAreDecidedAtOnce) {
  const auto verdict_of = [](double seconds) {
    Program program({1, seconds}, 1e-4, 1);
    return trial_of(program, 2, 100).verdict();
  };
  EXPECT_EQ(verdict_of(0.9), TrialVerdict::faster);
  EXPECT_EQ(verdict_of(1.1), TrialVerdict::slower);
  EXPECT_EQ(verdict_of(1.0), TrialVerdict::tie);
  EXPECT_EQ(verdict_of(0.99), TrialVerdict::tie);
}

TEST(PairedTrials, AnIntervalThatIsShownAsOneDecidesNothing) {
  const std::vector<double> noise{-0.02, 0.02, -0.01, 0.01, 0, 0};
  const double width = std::log(time_ratio_of(noise).high);
  const auto verdict_of = [&](double log) {
    PairedTrials trials(1);
    for (const double disturbance : noise)
      trials.add_round(std::vector<double>{std::exp(log + disturbance), 1});
    return trials.verdict();
  };
  ASSERT_GT(width, 2 * kTie);
  EXPECT_EQ(verdict_of(width + 0.0004), TrialVerdict::undecided);
  EXPECT_EQ(verdict_of(width + 0.002), TrialVerdict::faster);
  EXPECT_EQ(verdict_of(-width - 0.0004), TrialVerdict::undecided);
  EXPECT_EQ(verdict_of(-width - 0.002), TrialVerdict::slower);
}

TEST(PairedTrials, OrdersThatAreAllTheSameAreRarelyCalledDifferent) {
  constexpr int kTrials = 400;
  for (const std::size_t orders : {2, 5}) {
    for (const double budget : {12.0, 40.0, 120.0}) {
      int wrong = 0;
      for (int trial = 0; trial < kTrials; ++trial) {
        Program program(std::vector<double>(orders, 1), 0.02, static_cast<unsigned>(trial));
        const TrialVerdict verdict = trial_of(program, orders, budget).verdict();
        wrong += verdict == TrialVerdict::faster || verdict == TrialVerdict::slower ? 1 : 0;
      }
      EXPECT_LE(wrong, kTrials / 20) << orders << ' ' << budget;
    }
  }
}

/// As `try --budget 50` on a program of five seconds.
TEST(PairedTrials, TenRunsTellATenthApart) {
  constexpr int kTrials = 400;
  int told = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Program program({1, 0.9}, 0.01, static_cast<unsigned>(trial));
    const PairedTrials trials = trial_of(program, 2, 10);
    told += is_reportable(trials.speedup(1)) ? 1 : 0;
  }
  EXPECT_GE(told, kTrials * 2 / 3);
}

TEST(PairedTrials, FivePercentOfASecondAreFoundInFortySeconds) {
  constexpr int kTrials = 400;
  int found = 0;
  int right = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Program program({1, 1, 0.95, 1, 1}, 0.015, static_cast<unsigned>(trial));
    const PairedTrials trials = trial_of(program, 5, 40);
    found += trials.verdict() == TrialVerdict::faster ? 1 : 0;
    right += trials.best() == 2 ? 1 : 0;
  }
  EXPECT_GE(found, kTrials * 3 / 4);
  EXPECT_GE(right, kTrials * 9 / 10);
}

}  // namespace
}  // namespace meshorder
