// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/advice.hpp"

#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "payoff/kernel_bench.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr std::size_t kSpmv = 0;
constexpr std::size_t kElement = 1;
constexpr std::size_t kAssembly = 2;

Mesh grid_in_order(const std::string& vertices, const std::string& elements) {
  Mesh mesh = make_grid({.size = 20});
  reorder(mesh, {.methods = {vertices, elements}});
  return mesh;
}

AdviceOptions quick() { return {.machine = choose_machine("zen3")}; }

Advice advice_on(const Mesh& mesh, AdviceOptions options = quick()) {
  return advise(mesh, vertex_graph(mesh), options);
}

/// Invented milliseconds per kernel, as it is and for two candidates that cost 20 ms each.
Advice made_up(const KernelMilliseconds& as_is, const KernelMilliseconds& first,
               const KernelMilliseconds& second) {
  Advice advice;
  advice.as_is.costs.predicted = as_is;
  for (const KernelMilliseconds& predicted : {first, second}) {
    Candidate candidate;
    candidate.order_seconds = 0.02;
    candidate.costs.predicted = predicted;
    advice.candidates.push_back(candidate);
  }
  return advice;
}

TEST(Advice, SmallDifferencesCountWhereTheMachineItselfWasMeasured) {
  Advice advice;
  advice.as_is.costs.predicted.emplace();
  EXPECT_DOUBLE_EQ(same_time(advice, Kernel::element), 1.1);
  EXPECT_DOUBLE_EQ(same_time(advice, Kernel::spmv), 1.25);
  advice.floor = {0.01, 0.01, 0.02, 0.08};  // as a calibration finds it
  EXPECT_DOUBLE_EQ(same_time(advice, Kernel::element), 1.05);
  EXPECT_DOUBLE_EQ(same_time(advice, Kernel::spmv), 1.05);
  EXPECT_DOUBLE_EQ(same_time(advice, Kernel::springs), 1.08);
  advice.floor = {};
  advice.as_is.costs.measured.emplace();
  EXPECT_DOUBLE_EQ(same_time(advice, Kernel::spmv), 1.05);
}

TEST(Advice, AScrambledGridHasMuchToGain) {
  const Advice advice = advice_on(grid_in_order("scrambled", "scrambled"));
  const auto kernels = kernel_advice(advice);
  EXPECT_GT(kernels[kAssembly].gain.ratio, 1.5);
  EXPECT_GE(kernels[kAssembly].runs_to_pay, 1);
  EXPECT_GT(steps_to_pay(advice, 0), 0);
}

TEST(Advice, AMeshInTheOrderThatIsAdvisedHasNothingToGain) {
  const Advice advice = advice_on(grid_in_order("auto", "auto"));
  ASSERT_FALSE(advice.candidates.empty());
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    EXPECT_EQ(kernel_advice(advice)[k].runs_to_pay, 0) << to_string(kKernels[k]);
    EXPECT_NEAR((*advice.candidates[0].costs.predicted)[k] / (*advice.as_is.costs.predicted)[k], 1, 0.01);
  }
  EXPECT_EQ(steps_to_pay(advice, 0), 0);
}

TEST(Advice, IsOnTheFileThatWillBeWritten) {
  Mesh mesh = grid_in_order("scrambled", "scrambled");
  std::vector<std::int32_t> materials(mesh.cells.shapes.size());
  for (std::size_t c = 0; c < materials.size(); ++c) materials[c] = static_cast<std::int32_t>(c % 5);
  mesh.data.push_back({std::string(kLabel), Association::cells, 1, std::move(materials), {}, {}});
  AdviceOptions options = quick();
  options.methods = {{"hilbert", "lexmax"}};
  options.halvings = 0;
  options.format = "obj";
  const Advice advice = advice_on(mesh, options);
  reorder(mesh, {.methods = options.methods.front(), .format = "obj"});
  EXPECT_EQ(advice_on(mesh, options).as_is.costs.predicted, advice.candidates.front().costs.predicted);
}

TEST(Advice, SamplingChangesPredictedRatiosLittle) {
  const Mesh mesh = grid_in_order("scrambled", "scrambled");
  AdviceOptions exact = quick();
  exact.halvings = 0;
  AdviceOptions eighth = quick();
  eighth.halvings = 3;
  const Advice sampled = advice_on(mesh, eighth);
  const Advice measured = advice_on(mesh, exact);
  EXPECT_NE(*sampled.as_is.costs.predicted, *measured.as_is.costs.predicted);
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    // ratios of times; the advice's own factors are 1 below a threshold
    const auto ratio = [&](const Advice& advice) {
      return (*advice.as_is.costs.predicted)[k] / (*advice.candidates.front().costs.predicted)[k];
    };
    EXPECT_NEAR(ratio(sampled) / ratio(measured), 1, 0.06) << to_string(kKernels[k]);
  }
}

TEST(Advice, TakesTheReuseThatIsKnownOfTheMeshAsItIs) {
  const Mesh mesh = grid_in_order("scrambled", "scrambled");
  const CsrGraph graph = vertex_graph(mesh);
  const Advice computed = advice_on(mesh);
  AdviceOptions options = quick();
  options.reuse_as_is = reuse_of_kernels(graph, cut_into_simplices(mesh));
  EXPECT_EQ(*advice_on(mesh, options).as_is.costs.predicted, *computed.as_is.costs.predicted);
  const Mesh other = grid_in_order("hilbert", "lexmax");
  options.reuse_as_is = reuse_of_kernels(vertex_graph(other), cut_into_simplices(other));
  const Advice of_other = advice_on(mesh, options);
  EXPECT_EQ(*of_other.as_is.costs.predicted, *advice_on(other).as_is.costs.predicted);
  EXPECT_EQ(*of_other.candidates.front().costs.predicted, *computed.candidates.front().costs.predicted);
}

TEST(Advice, MeasuresWhereItIsAskedTo) {
  AdviceOptions options = quick();
  options.predict = false;
  EXPECT_THROW((void)advice_on(make_grid({.size = 4}), options), InvalidArgument);
  options.measure_within = 0.0;
  const Advice advice = advice_on(make_grid({.size = 8}), options);
  EXPECT_FALSE(advice.as_is.costs.predicted);
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    EXPECT_GT((*advice.as_is.costs.measured)[k], 0);
    EXPECT_GT((*advice.candidates.front().costs.measured)[k], 0);
  }
}

TEST(Advice, OnSeveralThreadsCountsWhatTheyComputeTwice) {
  const Mesh mesh = grid_in_order("scrambled", "scrambled");
  AdviceOptions options = quick();
  const Advice alone = advice_on(mesh, options);
  EXPECT_EQ(alone.threads, 1);
  options.threads = 2;
  EXPECT_THROW((void)advice_on(mesh, options), InvalidArgument);
  options.machine.model.threads = 2;  // costs of one thread: only repeated computations differ
  options.measure_within = 0.0;
  const Advice shared = advice_on(mesh, options);
  EXPECT_EQ(shared.threads, 2);
  const auto ratio = [&](std::size_t k) {
    return (*shared.as_is.costs.predicted)[k] / (*alone.as_is.costs.predicted)[k];
  };
  EXPECT_EQ(ratio(kSpmv), 1);
  // twice, except for elements whose corners are all on one thread by chance
  const double twice = times_computed(Kernel::element, vertex_graph(mesh), cut_into_simplices(mesh), 2);
  EXPECT_GT(twice, 1.8);
  EXPECT_NEAR(ratio(kElement), twice, 1e-9);
  EXPECT_NEAR(ratio(kAssembly), twice, 1e-9);
  EXPECT_GT((*shared.as_is.costs.measured)[kElement], 0);
  // as if two rounds on a busy machine had measured what was predicted
  Advice judged = shared;
  for (Candidate& candidate : judged.candidates) {
    candidate.costs.measured = candidate.costs.predicted;
    candidate.costs.gains.reset();
  }
  judged.as_is.costs.measured = judged.as_is.costs.predicted;
  judged.floor = alone.floor;
  judged.doubt.clear();
  judged.kernels = kernel_advice(judged);
  EXPECT_NE(to_string(judged).find("(measured here on 2 threads)"), std::string::npos) << to_string(judged);
}

TEST(Advice, ARaceTimesTheFirstAndThoseThatArePredictedToBeTheBest) {
  AdviceOptions options = quick();
  options.methods = {{"scrambled", "scrambled"},
                     {"bfs", "lexmax"},
                     {"bfs", "lexmax"},
                     {"hilbert", "lexmax"},
                     {"scrambled", "lexmax"}};
  options.race_of = 3;
  const Advice advice = advice_on(grid_in_order("scrambled", "original"), options);
  ASSERT_EQ(advice.candidates.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(advice.candidates[i].vertices.name, (std::array{"scrambled", "bfs", "hilbert"})[i]);
    EXPECT_TRUE(advice.candidates[i].costs.predicted);
    EXPECT_TRUE(advice.candidates[i].costs.measured);
  }
  EXPECT_TRUE(advice.as_is.costs.measured);
  EXPECT_LT(advice.candidates[2].spans.mean_span,
            advice.candidates[0].spans.mean_span / 4);  // the order that it names
  options.predict = false;
  EXPECT_THROW((void)advice_on(make_grid({.size = 4}), options), InvalidArgument);
}

TEST(Race, GoesToTheFastestForTheWorkload) {
  const Advice advice = made_up({2, 4, 30, 1}, {1.5, 3, 10, 0.5}, {1, 3, 30, 1});
  EXPECT_EQ(winner_for(Workload::spmv, advice), 1U);
  EXPECT_EQ(winner_for(Workload::assembly, advice), 0U);
  EXPECT_EQ(winner_for(Workload::all, advice), 0U);
  EXPECT_DOUBLE_EQ(gain_for(Workload::spmv, advice, 1).ratio, 2);
  EXPECT_DOUBLE_EQ(gain_for(Workload::all, advice, 1).ratio, std::pow(2 * 4.0 / 3, 0.25));
  EXPECT_DOUBLE_EQ(gain_for(Workload::spmv, advice, 1).low, 2 / 1.25) << "the error of predictions";
  EXPECT_THROW((void)winner_for(Workload::fill, advice), InvalidArgument);
}

TEST(Race, GoesToTheOrderThatIsThereAndThenToTheFirstOneWhereNoneIsMuchFaster) {
  EXPECT_EQ(winner_for(Workload::element, made_up({2, 2, 2, 2}, {2, 1.9, 2, 2}, {2, 1.85, 2, 2})),
            std::nullopt);
  EXPECT_EQ(winner_for(Workload::element, made_up({2, 2, 2, 2}, {2, 1.05, 2, 2}, {2, 1, 2, 2})), 0U);
  EXPECT_EQ(winner_for(Workload::element, made_up({2, 2, 2, 2}, {2, 1.15, 2, 2}, {2, 1, 2, 2})), 1U);
}

TEST(KernelAdvice, TakesTheFastestCandidateAndSaysWhenItHasPaid) {
  const auto kernels = kernel_advice(made_up({2, 4, 30, 1}, {2, 2, 10, 2}, {1, 3, 15, 0.99}));
  EXPECT_EQ(kernels[kSpmv].candidate, 1U);
  EXPECT_DOUBLE_EQ(kernels[kSpmv].gain.ratio, 2);
  EXPECT_EQ(kernels[kSpmv].runs_to_pay, 20);
  EXPECT_EQ(kernels[kElement].candidate, 0U);
  EXPECT_DOUBLE_EQ(kernels[kAssembly].gain.ratio, 3);
  EXPECT_EQ(kernels[kAssembly].runs_to_pay, 1);
  // a difference of one per cent does not count
  EXPECT_DOUBLE_EQ(kernels[3].gain.ratio, 1);
  EXPECT_EQ(kernels[3].runs_to_pay, 0);
}

TEST(KernelAdvice, TrustsMeasurementsMoreThanPredictions) {
  Advice advice = made_up({2, 2, 2, 2}, {1, 1, 1, 1}, {1, 1, 1, 1});
  advice.as_is.costs.measured = {3, 2, 2, 2};
  for (Candidate& candidate : advice.candidates) candidate.costs.measured = {1, 2, 2, 2};
  EXPECT_DOUBLE_EQ(kernel_advice(advice)[kSpmv].gain.ratio, 3);
  EXPECT_DOUBLE_EQ(kernel_advice(advice)[kElement].gain.ratio, 1);
}

/// As if the kernels of all candidates had been timed in rounds.
Advice timed(const std::array<TimeRatio, kKernels.size()>& first,
             const std::array<TimeRatio, kKernels.size()>& second) {
  Advice advice = made_up({2, 2, 2, 2}, {2, 2, 2, 2}, {2, 2, 2, 2});
  advice.as_is.costs.measured = {4, 4, 4, 4};
  advice.machine = "zen3";
  for (std::size_t i = 0; i < 2; ++i) {
    Candidate& candidate = advice.candidates[i];
    candidate.vertices.name = i == 0 ? "hilbert" : "rcm";
    candidate.elements.name = "lexmax";
    candidate.costs.measured = {4, 4, 4, 4};
    candidate.costs.gains = i == 0 ? first : second;
  }
  advice.kernels = kernel_advice(advice);
  return advice;
}

constexpr TimeRatio kSame{1, 0.98, 1.02};

TEST(TimeRatio, IsToldApartIfTheIntervalIsNarrowAndDoesNotHoldOne) {
  EXPECT_TRUE(is_told_apart({1.1, 1.01, 1.2}));
  EXPECT_TRUE(is_told_apart({0.9, 0.8, 0.99}));
  EXPECT_FALSE(is_told_apart({1.1, 1.0, 1.2}));
  EXPECT_FALSE(is_told_apart({0.9, 0.8, 1.0}));
  EXPECT_FALSE(is_told_apart({5, 3, 3 * 1.61})) << "too wide";
  EXPECT_FALSE(is_told_apart({})) << "no interval";
}

TEST(Verdict, StatesARangeAndTheRunsThatPay) {
  const Advice advice = timed({kSame, kSame, TimeRatio{2, 1.9, 2.124}, TimeRatio{0.8, 0.75, 0.85}},
                              {kSame, kSame, kSame, kSame});
  EXPECT_EQ(advised(advice), 0U);
  EXPECT_EQ(
      to_string(advice),
      "as it is, the assembly kernel takes 1.90 to 2.1 times as long as it could (measured here); `meshorder "
      "order --vertices hilbert --elements lexmax` takes 20 ms and pays off after 10 runs of it; it makes "
      "the "
      "springs kernel 1.18 to 1.33 times slower");
  EXPECT_DOUBLE_EQ(certain_gain(advice)->low, 1.9);
}

TEST(Verdict, OfTimesInDoubtIsThatOfThePredictions) {
  Advice advice = timed({kSame, kSame, TimeRatio{2, 1.9, 2.1}, kSame}, {kSame, kSame, kSame, kSame});
  advice.doubt = "this machine is too busy";
  advice.kernels = kernel_advice(advice);
  EXPECT_EQ(advised(advice), std::nullopt);
  EXPECT_EQ(
      to_string(advice),
      "nothing to gain: no kernel is more than 1.25 times as fast in another order (predicted for zen3)");
  for (Candidate& candidate : advice.candidates) candidate.costs.predicted = {2, 2, 1, 2};
  advice.kernels = kernel_advice(advice);
  EXPECT_NE(
      to_string(advice).find("assembly kernel takes 1.82 to 2.2 times as long as it could (predicted for"),
      std::string::npos)
      << to_string(advice);
  advice.as_is.costs.predicted.reset();
  advice.kernels = kernel_advice(advice);
  EXPECT_EQ(to_string(advice), "the gain is not known: this machine is too busy");
}

TEST(Verdict, OfWideIntervalsNamesNoGain) {
  const TimeRatio wide{2, 1.2, 3.3};
  const Advice advice = timed({wide, wide, wide, wide}, {kSame, kSame, kSame, kSame});
  EXPECT_EQ(advised(advice), std::nullopt);
  EXPECT_EQ(to_string(advice), "the gain is not known: up to 3.3 times is possible (measured here)");
}

TEST(Grade, ComparesTheSpansWithARandomOrderAndABetterOne) {
  const auto graded = [](double mean_log2) {
    return to_string(grade_of({.mean_log2_span = mean_log2}, {.mean_log2_span = 5}, 1 << 13));
  };
  // a random order of 8,192 vertices has a mean of 10.84
  EXPECT_EQ(graded(4), "good");
  EXPECT_EQ(graded(5.9), "good");
  EXPECT_EQ(graded(6.1), "fair");
  EXPECT_EQ(graded(7.8), "fair");
  EXPECT_EQ(graded(8), "poor");
  EXPECT_EQ(graded(10.8), "poor");
}

TEST(Grade, OfASmallMeshIsGoodIfNoOrderIsNearer) {
  // the mean of a random order of 5 vertices is taken as 0.16, less than that of any order
  for (const double mean_log2 : {0.2, 0.5}) {
    EXPECT_EQ(grade_of({.mean_log2_span = mean_log2}, {.mean_log2_span = 0.5}, 5), OrderGrade::good);
  }
}

TEST(Comparison, NamesTheBestOrderOfAllKernelsOrOfOne) {
  const TimeRatio twice{2, 1.95, 2.05};
  const Advice advice = timed({twice, twice, twice, twice}, {kSame, kSame, kSame, TimeRatio{4, 3.9, 4.1}});
  EXPECT_EQ(
      comparison_in_words(advice, Workload::all),
      "the kernels run 1.95 to 2.0 times faster in hilbert than in the file's own order, in their geometric "
      "mean; it takes 20 ms and pays off after 1 time step");
  EXPECT_EQ(comparison_in_words(advice, Workload::springs),
            "the springs kernel runs 3.9 to 4.1 times faster in rcm than in the file's own order; it takes "
            "20 ms and "
            "pays off after 7 runs of that kernel");
  EXPECT_EQ(comparison_in_words(advice, Workload::fill), comparison_in_words(advice, Workload::all))
      << "no kernel measures it";
}

TEST(Comparison, SaysWhereNothingIsGained) {
  EXPECT_EQ(
      comparison_in_words(timed({kSame, kSame, kSame, kSame}, {kSame, kSame, kSame, kSame}), Workload::all),
      "nothing to gain: no kernel is more than 1.02 times as fast in another order (measured here)");
  const TimeRatio half{0.5, 0.48, 0.52};
  EXPECT_EQ(
      comparison_in_words(timed({kSame, kSame, kSame, kSame}, {TimeRatio{2, 1.9, 2.1}, half, half, half}),
                          Workload::all),
      "no order is better for all kernels; best for the SpMV kernel is rcm");
}

TEST(StepsToPay, CountRunsLossesAndNoNoise) {
  // 2 + 20 ms saved in each step by an order of 20 ms; a loss of 100 ms
  const Advice advice = made_up({2, 4, 30, 1}, {2.1, 2, 10, 2}, {3, 4, 30, 1});
  EXPECT_DOUBLE_EQ(saved_ms(advice, 0, kSpmv), 0);
  EXPECT_DOUBLE_EQ(saved_ms(advice, 0, kElement), 2);
  EXPECT_DOUBLE_EQ(steps_to_pay(advice, 0), 1);
  EXPECT_DOUBLE_EQ(saved_ms(advice, 1, kSpmv), -1);
  EXPECT_EQ(steps_to_pay(advice, 1), 0);
}

}  // namespace
}  // namespace meshorder
