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
  EXPECT_GT(kernels[kAssembly].factor, 1.5);
  EXPECT_GE(kernels[kAssembly].runs_to_pay, 1);
  EXPECT_GT(saved_in_time_step(advice, 0), 0);
}

TEST(Advice, AMeshInTheOrderThatIsAdvisedHasNothingToGain) {
  const Advice advice = advice_on(grid_in_order("auto", "auto"));
  ASSERT_FALSE(advice.candidates.empty());
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    EXPECT_EQ(kernel_advice(advice)[k].runs_to_pay, 0) << to_string(kKernels[k]);
    EXPECT_NEAR((*advice.candidates[0].costs.predicted)[k] / (*advice.as_is.costs.predicted)[k], 1, 0.01);
  }
  EXPECT_EQ(saved_in_time_step(advice, 0), 0);
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
  for (Candidate& candidate : judged.candidates) candidate.costs.measured = candidate.costs.predicted;
  judged.as_is.costs.measured = judged.as_is.costs.predicted;
  judged.floor = alone.floor;
  judged.doubt.clear();
  judged.kernels = kernel_advice(judged);
  EXPECT_NE(to_string(judged).find("slower on 2 threads than it could"), std::string::npos)
      << to_string(judged);
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
  EXPECT_DOUBLE_EQ(factor_for(Workload::spmv, advice, 1), 2);
  EXPECT_DOUBLE_EQ(factor_for(Workload::all, advice, 1), std::pow(2 * 4.0 / 3, 0.25));
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
  EXPECT_DOUBLE_EQ(kernels[kSpmv].factor, 2);
  EXPECT_EQ(kernels[kSpmv].runs_to_pay, 20);
  EXPECT_EQ(kernels[kElement].candidate, 0U);
  EXPECT_DOUBLE_EQ(kernels[kAssembly].factor, 3);
  EXPECT_EQ(kernels[kAssembly].runs_to_pay, 1);
  // a difference of one per cent does not count
  EXPECT_DOUBLE_EQ(kernels[3].factor, 1);
  EXPECT_EQ(kernels[3].runs_to_pay, 0);
}

TEST(KernelAdvice, TrustsMeasurementsMoreThanPredictions) {
  Advice advice = made_up({2, 2, 2, 2}, {1, 1, 1, 1}, {1, 1, 1, 1});
  advice.as_is.costs.measured = {3, 2, 2, 2};
  for (Candidate& candidate : advice.candidates) candidate.costs.measured = {1, 2, 2, 2};
  EXPECT_DOUBLE_EQ(kernel_advice(advice)[kSpmv].factor, 3);
  EXPECT_DOUBLE_EQ(kernel_advice(advice)[kElement].factor, 1);
}

TEST(Verdict, SaysTheDirectionAloneWhereTimesAreInDoubt) {
  Advice advice = made_up({2, 2, 2, 2}, {1, 1, 1, 1}, {1, 1, 1, 1});
  advice.as_is.costs.measured = {2, 2, 6, 2};
  for (Candidate& candidate : advice.candidates) candidate.costs.measured = {2, 2, 2, 2};
  advice.kernels = kernel_advice(advice);
  EXPECT_EQ(advised(advice), 0U);
  EXPECT_NE(to_string(advice).find("assembly kernel runs 3.0× slower than it could (measured here)"),
            std::string::npos)
      << to_string(advice);
  advice.doubt = "the machine was busy";
  advice.floor.fill(0.4);
  EXPECT_NE(to_string(advice).find("3.0"), std::string::npos)
      << "five times the noise: " << to_string(advice);
  advice.floor.fill(0.6);
  EXPECT_EQ(to_string(advice).find("3.0"), std::string::npos) << to_string(advice);
  EXPECT_NE(to_string(advice).find("assembly kernel runs slower than it could (measured here while the"),
            std::string::npos)
      << to_string(advice);
  advice.as_is.costs.measured = {2, 2, 2, 2};
  advice.kernels = kernel_advice(advice);
  EXPECT_EQ(advised(advice), std::nullopt);
  EXPECT_NE(to_string(advice).find("nothing to gain"), std::string::npos);
}

TEST(Comparison, NamesTheBestOrderOfAllKernelsOrOfOne) {
  Advice advice = made_up({2, 2, 2, 2}, {1, 1, 1, 1}, {1, 1, 1, 1});
  advice.as_is.costs.measured = {4, 4, 4, 4};
  advice.candidates[0].costs.measured = {2, 2, 2, 2};
  advice.candidates[1].costs.measured = {4, 4, 4, 1};
  advice.candidates[0].vertices.name = "hilbert";
  advice.candidates[1].vertices.name = "rcm";
  for (Candidate& candidate : advice.candidates) candidate.elements.name = "lexmax";
  for (Candidate& candidate : advice.candidates) candidate.order_seconds = 0.3;
  advice.kernels = kernel_advice(advice);
  EXPECT_EQ(
      comparison_in_words(advice, Workload::all),
      "the kernels run 2.00× faster in hilbert than in the file's own order, in their geometric mean; it "
      "takes 300 ms and pays off after 2 time steps");
  EXPECT_EQ(comparison_in_words(advice, Workload::springs),
            "the springs kernel runs 4.00× faster in rcm than in the file's own order; it takes 300 ms and "
            "pays off "
            "after 100 runs of the springs kernel");
  EXPECT_EQ(comparison_in_words(advice, Workload::fill), comparison_in_words(advice, Workload::all))
      << "no kernel measures it";
  EXPECT_DOUBLE_EQ(*certain_gain(advice), 2) << "of the order that is advised";
  advice.doubt = "the machine was busy";
  advice.floor.fill(0.5);
  EXPECT_EQ(
      comparison_in_words(advice, Workload::all),
      "the kernels run faster in hilbert than in the file's own order (measured while the machine was busy: "
      "the amount is uncertain)");
  EXPECT_EQ(certain_gain(advice), std::nullopt);
}

TEST(Comparison, SaysWhereNothingIsGainedAndDoesNotTakeChanceForAGain) {
  Advice advice = made_up({2, 2, 2, 2}, {1, 1, 1, 1}, {1, 1, 1, 1});
  advice.as_is.costs.measured = {4, 4, 4, 4};
  for (Candidate& candidate : advice.candidates) candidate.costs.measured = {3.7, 4, 4, 4};
  advice.kernels = kernel_advice(advice);
  EXPECT_EQ(comparison_in_words(advice, Workload::all),
            "nothing to gain: the kernels run no faster in these orders than in the file's own, within the "
            "uncertainty of the measurement");
  advice.candidates[1].costs.measured = {2, 8, 8, 8};
  advice.candidates[1].vertices.name = "rcm";
  advice.candidates[1].elements.name = "original";
  advice.kernels = kernel_advice(advice);
  EXPECT_EQ(comparison_in_words(advice, Workload::all),
            "no order is better for all kernels; best for the SpMV kernel is rcm/original");
}

TEST(SavedInTimeStep, CountsRunsLossesAndNoNoise) {
  const Advice advice = made_up({2, 4, 30, 1}, {2.1, 2, 10, 2}, {3, 4, 30, 1});
  EXPECT_DOUBLE_EQ(saved_in_time_step(advice, 0), 2 + 20);
  EXPECT_DOUBLE_EQ(saved_in_time_step(advice, 1), -100);
}

}  // namespace
}  // namespace meshorder
