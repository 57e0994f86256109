// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/statistics.hpp"

#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace meshorder {
namespace {

RunRecord run_of(std::vector<double> step_seconds) {
  RunRecord run;
  run.step_seconds = std::move(step_seconds);
  return run;
}

std::vector<RunRecord> runs_of(const std::vector<std::vector<double>>& steps_by_run) {
  std::vector<RunRecord> runs;
  for (const std::vector<double>& steps : steps_by_run) runs.push_back(run_of(steps));
  return runs;
}

TEST(Statistics, SummariesAreOfTheSumsOfRuns) {
  const TimeSummary summary = summary_of(runs_of({{1, 2, 3}, {2, 2, 2}, {3, 4, 2}}));
  EXPECT_DOUBLE_EQ(summary.mean, 7);                    // of 6, 6, 9
  EXPECT_DOUBLE_EQ(summary.deviation, std::sqrt(3.0));  // (1 + 1 + 4) / 2
  EXPECT_DOUBLE_EQ(summary.undisturbed, 1 + 2 + 2);
  EXPECT_EQ(summary_of(runs_of({{1, 2}})), (TimeSummary{.mean = 3, .deviation = 0, .undisturbed = 3}));
  EXPECT_EQ(summary_of({}), TimeSummary{});
}

TEST(Statistics, TheIntervalIsThatOfHandCalculation) {
  // two turns of two runs: saved 4 and 2 in the first turn, 6 and 8 in the last, shorter one
  const auto reference = runs_of({{5, 5, 10}, {5, 5, 10}});
  const auto runs = runs_of({{3, 3, 4}, {4, 4, 2}});
  const Speedup speedup = speedup_of(runs, reference, 2, 0);
  EXPECT_DOUBLE_EQ(speedup.saved_seconds, 10);
  EXPECT_DOUBLE_EQ(speedup.percent, 50);
  // both turns have the variance 2, so the standard error is √((2 + 2) / 2) s. Times Student's t for 2
  // degrees of freedom, and as a share of 20 s
  const double half_width = 100 * 4.302652729749464 * std::sqrt(2.0) / 20;
  EXPECT_NEAR(speedup.low, 50 - half_width, 1e-9);
  EXPECT_NEAR(speedup.high, 50 + half_width, 1e-9);
  EXPECT_TRUE(speedup.beyond_noise);
  EXPECT_DOUBLE_EQ(speedup.undisturbed_percent, 60);  // 8 of 20 s
}

TEST(Statistics, TheIntervalOfOneRunIsThatOfARatio) {
  const Speedup speedup = speedup_of(runs_of({{4, 9, 2}}), runs_of({{5, 10, 5}}), 1, 0);
  EXPECT_DOUBLE_EQ(speedup.percent, 25);
  // residuals 4 − ¾·5, 9 − ¾·10, 2 − ¾·5: their squares are 0.0625 + 2.25 + 3.0625; the variance of the sum
  // is 3/2 times their sum
  const double half_width = 100 * 4.302652729749464 * std::sqrt(1.5 * 5.375) / 20;
  EXPECT_NEAR(speedup.low, 25 - half_width, 1e-9);
  EXPECT_NEAR(speedup.high, 25 + half_width, 1e-9);
  EXPECT_FALSE(speedup.beyond_noise);
}

TEST(Statistics, OneTurnOfOneRunIsNeverBeyondTheNoise) {
  const Speedup speedup = speedup_of(runs_of({{1, 1}}), runs_of({{2, 2}}), 2, 0);
  EXPECT_DOUBLE_EQ(speedup.percent, 50);
  EXPECT_DOUBLE_EQ(speedup.low, 50);
  EXPECT_DOUBLE_EQ(speedup.high, 50);
  EXPECT_FALSE(speedup.beyond_noise);
}

TEST(Statistics, AnOrderThatLosesIsSlowerBeyondTheNoiseAndNeverPays) {
  const auto reference = runs_of({{1, 1.01}, {1.01, 1}});
  const auto runs = runs_of({{1.5, 1.5}, {1.5, 1.51}});
  const Speedup speedup = speedup_of(runs, reference, 1, 0);
  EXPECT_LT(speedup.percent, -40);
  EXPECT_LT(speedup.high, 0);
  EXPECT_TRUE(speedup.beyond_noise);
  EXPECT_EQ(speedup.break_even_step, std::nullopt);
}

TEST(Statistics, BreaksEvenAtTheEndOfTheFirstStepThatHasPaid) {
  const auto reference = runs_of({{3, 3, 3, 3}, {3, 3, 3, 3}});
  const auto runs = runs_of({{2, 1, 2, 2}, {2, 3, 2, 2}});  // saved by the means: 1, 1, 1, 1
  const auto step = [&](double cost) { return speedup_of(runs, reference, 2, cost).break_even_step; };
  EXPECT_EQ(step(0), 1);
  EXPECT_EQ(step(1), 1);
  EXPECT_EQ(step(1.5), 2);
  EXPECT_EQ(step(4), 4);
  EXPECT_EQ(step(4.5), std::nullopt);
}

/// 240 steps in turns of 8. The order saves a fifth of most steps; times have noise.
struct NoisyStudy {
  std::vector<RunRecord> runs, reference;
  double true_percent = 0;
};

struct Noise {
  double of_step = 0;  ///< standard deviations, as shares of a step
  double of_run = 0;
  double drift = 0;  ///< of the machine, the same for both orders in a turn
};

NoisyStudy noisy_study(int runs, const Noise& noise, std::mt19937& random) {
  NoisyStudy study;
  std::normal_distribution<double> normal;
  std::exponential_distribution<double> exponential;  // noise slows down more than it speeds up
  double spent = 0, saved = 0;
  for (int r = 0; r < runs; ++r) {
    const double phase = exponential(random);
    const double of_run = 1 + noise.of_run * normal(random);
    RunRecord& run = study.runs.emplace_back();
    RunRecord& reference = study.reference.emplace_back();
    for (int step = 0; step < 240; ++step) {
      const double physics = step < 120 ? 1 : 2 + std::sin(0.1 * step);
      const double ratio = step % 40 < 30 || runs == 1 ? 0.8 : 1;
      const double drift = 1 + noise.drift * std::sin(phase + 0.01 * (step - step % 8));
      const auto disturbed = [&] { return drift * (1 + noise.of_step * (exponential(random) - 1)); };
      reference.step_seconds.push_back(physics * disturbed());
      run.step_seconds.push_back(physics * ratio * of_run * disturbed());
      spent += physics;
      saved += physics * (1 - ratio);
    }
  }
  study.true_percent = 100 * saved / spent;
  return study;
}

/// The number of studies out of 1000 whose interval contains the true value.
int held(int runs, const Noise& noise) {
  std::mt19937 random(7);
  int count = 0;
  for (int i = 0; i < 1000; ++i) {
    const NoisyStudy study = noisy_study(runs, noise, random);
    const Speedup speedup = speedup_of(study.runs, study.reference, 8, 0);
    count += speedup.low <= study.true_percent && study.true_percent <= speedup.high ? 1 : 0;
  }
  return count;
}

void expect_about_95_percent(int count) {
  EXPECT_GE(count, 920);
  EXPECT_LE(count, 980);
}

TEST(Statistics, IntervalsHoldTheTruthIn19CasesOf20) {
  expect_about_95_percent(held(3, {.of_step = 0.1}));
  expect_about_95_percent(held(2, {.of_step = 0.1}));
  expect_about_95_percent(held(10, {.of_step = 0.1}));
}

TEST(Statistics, AMachineThatChangesItsPaceDoesNotSpoilThem) {
  expect_about_95_percent(held(3, {.of_step = 0.1, .drift = 0.05}));
}

TEST(Statistics, IntervalsOfOneRunHoldTheTruthWhereTheRatioIsTheSame) {
  expect_about_95_percent(held(1, {.of_step = 0.1, .drift = 0.05}));
}

TEST(Statistics, RunsThatDifferAsAWholeWidenThem) {
  // intervals from turns alone would rarely contain the true value
  EXPECT_GE(held(3, {.of_step = 0.02, .of_run = 0.05}), 900);
}

TEST(Statistics, DifferencesThatAreNoneAreRarelyBeyondTheNoise) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal(1, 0.05);
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<std::vector<double>> steps(6, std::vector<double>(60));
    for (std::vector<double>& run : steps) {
      for (double& seconds : run) seconds = normal(random);
    }
    const Speedup speedup =
        speedup_of(runs_of({steps[0], steps[1], steps[2]}), runs_of({steps[3], steps[4], steps[5]}), 4, 0);
    EXPECT_EQ(speedup.beyond_noise, speedup.low > 0 || speedup.high < 0);
    found += speedup.beyond_noise ? 1 : 0;
  }
  EXPECT_LE(found, 80);
  EXPECT_GE(found, 20);
}

TEST(Statistics, RefuseRunsThatDoNotFitEachOther) {
  const auto two = runs_of({{1, 1}, {1, 1}});
  EXPECT_THROW(speedup_of(two, runs_of({{1, 1}}), 1, 0), InvalidArgument);
  EXPECT_THROW(speedup_of(two, runs_of({{1, 1}, {1}}), 1, 0), InvalidArgument);
  EXPECT_THROW(speedup_of(runs_of({{1}, {1}}), two, 1, 0), InvalidArgument);
  EXPECT_THROW(speedup_of({}, {}, 1, 0), InvalidArgument);
  EXPECT_THROW(speedup_of(two, two, 0, 0), InvalidArgument);
}

ScenarioOrderRecord order_with(const std::string& ordering, const std::vector<std::vector<double>>& steps) {
  ScenarioOrderRecord order;
  order.ordering = ordering;
  order.runs = runs_of(steps);
  return order;
}

StudyResults small_study() {
  StudyResults results;
  results.reference = "scrambled";
  MeshRecord& mesh = results.meshes.emplace_back();
  mesh.name = "grid";
  mesh.orders.resize(2);
  mesh.orders[0].ordering = "scrambled";
  mesh.orders[1].ordering = "fiedler";
  mesh.orders[1].seconds = 1.5;
  ScenarioRecord& scenario = results.scenarios.emplace_back();
  scenario.mesh = "grid";
  scenario.steps = 3;
  scenario.turn = 1;
  scenario.orders = {order_with("original", {{1.5, 1.5, 1.5}}),  // one run has been done
                     order_with("fiedler", {{1, 1, 1}, {1, 1, 1.1}}),
                     order_with("scrambled", {{2, 2, 2}, {2, 2, 2}})};
  return results;
}

TEST(Summarise, TakesTheOrdersCostsFromTheMesh) {
  StudyResults results = small_study();
  summarise(results);
  const std::vector<ScenarioOrderRecord>& orders = results.scenarios[0].orders;
  EXPECT_DOUBLE_EQ(orders[1].time.mean, 3.05);
  EXPECT_DOUBLE_EQ(orders[1].speedup.saved_seconds, 2.95);
  EXPECT_EQ(orders[1].speedup.break_even_step, 2);
  EXPECT_EQ(orders[2].speedup, Speedup{});
  EXPECT_DOUBLE_EQ(orders[2].time.mean, 6);
}

TEST(Summarise, ComparesTheRunsThatBothHave) {
  StudyResults results = small_study();
  summarise(results);
  const ScenarioOrderRecord& original = results.scenarios[0].orders[0];
  EXPECT_DOUBLE_EQ(original.speedup.percent, 25);
  EXPECT_EQ(original.speedup.break_even_step, std::nullopt) << "its cost is not known";
}

TEST(Summarise, KeepsSummariesWithoutTheReference) {
  StudyResults results = small_study();
  results.scenarios[0].orders.pop_back();
  results.scenarios[0].orders[0].speedup.percent = 3;  // from an earlier reference
  summarise(results);
  EXPECT_DOUBLE_EQ(results.scenarios[0].orders[1].time.mean, 3.05);
  EXPECT_EQ(results.scenarios[0].orders[0].speedup, Speedup{});
}

struct Quantile {
  Index degrees;
  double of_95, of_99;
};

TEST(StudentT, IsThatOfSciPy) {
  // scipy.stats.t.ppf([0.975, 0.995], degrees) of SciPy 1.10.1, good to 2e-9
  for (const Quantile& q :
       {Quantile{1, 12.706204736432095, 63.65674116287399}, Quantile{2, 4.302652729911275, 9.92484320091807},
        Quantile{3, 3.182446305284263, 5.84090929975643}, Quantile{4, 2.7764451051977987, 4.604094871415897},
        Quantile{5, 2.5705818366147395, 4.032142983557536},
        Quantile{30, 2.0422724563012373, 2.7499956535670305},
        Quantile{476, 1.964960228540678, 2.5861972903853063},
        Quantile{2000, 1.9611508260994375, 2.5782897875575186}}) {
    EXPECT_NEAR(student_t(q.degrees, 0.95), q.of_95, 1e-8 * q.of_95) << q.degrees;
    EXPECT_NEAR(student_t(q.degrees, 0.99), q.of_99, 1e-8 * q.of_99) << q.degrees;
  }
}

TEST(StudentT, IsThatOfTheClosedForms) {
  for (const double p : {0.5, 0.95, 0.999}) {
    EXPECT_NEAR(student_t(1, p), std::tan(p * std::numbers::pi / 2), 1e-12 * student_t(1, p));
    EXPECT_NEAR(student_t(2, p), p * std::sqrt(2 / (1 - p * p)), 1e-12 * student_t(2, p));
  }
}

TEST(StudentT, RefusesWhatIsNoDistribution) {
  EXPECT_THROW(student_t(0, 0.95), InvalidArgument);
  EXPECT_THROW(student_t(1, 1), InvalidArgument);
  EXPECT_THROW(student_t(1, 0), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
