// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/race.hpp"

#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace meshorder {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

Mesh scrambled_grid() {
  Mesh mesh = make_grid({.size = 12});
  reorder(mesh, {.methods = {"scrambled", "scrambled"}});
  return mesh;
}

/// Races a scrambled grid. Order i takes `milliseconds[i]` in every kernel; the mesh's own order is order 0.
Race raced(const std::vector<double>& milliseconds, Workload workload = Workload::all, double waiting = 0) {
  const Mesh mesh = scrambled_grid();
  RaceOptions options;
  options.machine = choose_machine("zen3");
  options.ordering.workload = workload;
  options.timer = [&](Index orders, const auto& /*prepare*/, const TimingOptions& /*timing*/) {
    Timings timings{
        .orders = std::vector<OrderTimes>(static_cast<std::size_t>(orders)), .again = {}, .steadiness = {}};
    for (std::size_t i = 0; i < timings.orders.size(); ++i) {
      const double ratio = milliseconds.front() / milliseconds.at(i);
      for (const Kernel kernel : kKernels) {
        timings.orders[i][kernel].best_ms = milliseconds.at(i);
        timings.orders[i][kernel].gain = {ratio, ratio / 1.05, ratio * 1.05};
      }
    }
    timings.steadiness.waiting = waiting;
    return timings;
  };
  return race(mesh, vertex_graph(mesh), options);
}

TEST(Race, GoesToTheOrderThatIsTimedAsTheFastest) {
  const Race result = raced({8, 4, 2, 5});
  ASSERT_EQ(result.advice.candidates.size(), 3U);
  EXPECT_THAT(result.factors, ElementsAre(DoubleEq(2), DoubleEq(4), DoubleEq(1.6)));
  EXPECT_EQ(result.winner, 1U);
  EXPECT_EQ(result.methods().vertices, result.advice.candidates[1].vertices.name);
  EXPECT_EQ(result.methods().elements, result.advice.candidates[1].elements.name);
  EXPECT_EQ(result.reason,
            "4.00 times as fast as the file's order; none of 3 orders timed here is faster by more than the "
            "variation of the times");
  EXPECT_EQ(result.advice.doubt, "");
}

TEST(Race, GoesToTheMeshsOwnOrderWhereNoneIsFasterByMoreThanTimesVary) {
  const Race result = raced({8, 8.1, 7.9, 9});
  EXPECT_EQ(result.winner, std::nullopt);
  EXPECT_EQ(result.methods(), (MeshMethods{"original", "original"}));
  EXPECT_EQ(result.reason,
            "none of 3 orders timed here is faster than the file's by more than the variation of the times");
}

TEST(Race, TimesWhatAutoTakesAndTwoOthersForHalfASecondEach) {
  const Mesh mesh = scrambled_grid();
  const CsrGraph graph = vertex_graph(mesh);
  constexpr double kGraphSeconds = 1000;
  RaceOptions options;
  options.graph_seconds = kGraphSeconds;
  options.machine = choose_machine("zen3");
  Index timed = 0;
  TimingOptions timing;
  std::vector<double> bytes;
  options.timer = [&](Index orders, const auto& prepare, const TimingOptions& given) {
    timed = orders;
    timing = given;
    for (Index i = 0; i < orders; ++i) bytes.push_back(prepare(i)->streamed_bytes(Kernel::spmv));
    return Timings{
        .orders = std::vector<OrderTimes>(static_cast<std::size_t>(orders)), .again = {}, .steadiness = {}};
  };
  const Race result = race(mesh, graph, options);
  EXPECT_EQ(timed, 4);
  EXPECT_DOUBLE_EQ(timing.budget_seconds, 2);
  // the same mesh in another order
  EXPECT_THAT(bytes, testing::Each(testing::AllOf(testing::Gt(0), bytes.front())));
  const MeshOrder by_auto = compute_reordering(mesh, graph, {});
  EXPECT_EQ(result.advice.candidates.front().vertices.name, by_auto.vertices.method.name);
  EXPECT_EQ(result.advice.candidates.front().elements.name, by_auto.cells.method.name);
  for (const Candidate& candidate : result.advice.candidates) {
    EXPECT_GE(candidate.order_seconds, kGraphSeconds);
    EXPECT_TRUE(candidate.costs.predicted);
  }
}

TEST(Race, ReportsTimesThatAreNotReliable) {
  EXPECT_THAT(raced({8, 4, 2, 5}, Workload::spmv, 0.5).advice.doubt, HasSubstr("50"));
}

TEST(Race, WithoutATimerPredictionsDecide) {
  const Mesh mesh = scrambled_grid();
  RaceOptions options;
  options.machine = choose_machine("zen3");
  options.ordering.workload = Workload::assembly;
  options.timer = {};
  const Race result = race(mesh, vertex_graph(mesh), options);
  ASSERT_EQ(result.advice.candidates.size(), 3U);
  ASSERT_TRUE(result.winner);
  const auto assembly = static_cast<std::size_t>(Kernel::assembly);
  const auto predicted = [&](const OrderCosts& costs) { return costs.predicted.value()[assembly]; };
  const double taken = predicted(result.advice.candidates[*result.winner].costs);
  EXPECT_LT(taken, predicted(result.advice.as_is.costs));
  for (const Candidate& candidate : result.advice.candidates) {
    EXPECT_FALSE(candidate.costs.measured);
    EXPECT_LT(taken, 1.1 * predicted(candidate.costs));
  }
  EXPECT_THAT(result.reason, testing::StartsWith("predicted to be "));
  EXPECT_THAT(result.reason,
              testing::EndsWith(" for zen3; no other order is predicted to be faster by more than "
                                "the error of predictions"));
}

TEST(Race, WithoutATimerAGoodOrderStays) {
  Mesh mesh = make_grid({.size = 12});
  reorder(mesh, {.methods = {"bfs", "lexmax"}});
  RaceOptions options;
  options.machine = choose_machine("zen3");
  options.timer = {};
  const Race result = race(mesh, vertex_graph(mesh), options);
  EXPECT_EQ(result.winner, std::nullopt);
  EXPECT_EQ(
      result.reason,
      "for zen3, no order is predicted to be faster than the file's by more than the error of predictions");
}

TEST(Race, LeavesOutOrdersByCoordinatesForAMatrixWithoutThem) {
  const Mesh mesh = scrambled_grid();
  const CsrGraph graph = vertex_graph(mesh);
  Mesh matrix = matrix_mesh({graph.offsets, graph.neighbours});
  const auto orders = [&] {
    std::vector<std::string> names;
    RaceOptions options;
    options.machine = choose_machine("zen3");
    options.ordering.workload = Workload::spmv;
    options.timer = [](Index timed, const auto& /*prepare*/, const TimingOptions& /*timing*/) {
      return Timings{
          .orders = std::vector<OrderTimes>(static_cast<std::size_t>(timed)), .again = {}, .steadiness = {}};
    };
    for (const Candidate& candidate : race(matrix, graph, options).advice.candidates) {
      names.push_back(candidate.vertices.name);
      EXPECT_EQ(candidate.elements.name, "original");
    }
    return names;
  };
  EXPECT_THAT(orders(), testing::Each(testing::Not(HasSubstr("hilbert"))));
  matrix.points = mesh.points;
  EXPECT_THAT(orders(), testing::Contains(HasSubstr("hilbert")));
}

TEST(Race, RefusesWhatNoKernelMeasures) {
  for (const Workload workload : {Workload::fill, Workload::bandwidth}) {
    const auto message = testing::StartsWith("race: no kernel measures ");  // before any work
    EXPECT_THAT([&] { (void)raced({}, workload); }, testing::ThrowsMessage<InvalidArgument>(message));
  }
}

TEST(Race, IsTheReasonForBothMethods) {
  MeshOrder order;
  Race result;
  result.reason = "it is the fastest";
  give_reasons(result, order);
  EXPECT_EQ(order.vertices.method.reason, "it is the fastest");
  EXPECT_EQ(order.cells.method.reason, "predicted together with the order of the vertices");
  result.advice.as_is.costs.measured = KernelMilliseconds{};
  give_reasons(result, order);
  EXPECT_EQ(order.cells.method.reason, "timed together with the order of the vertices");
}

}  // namespace
}  // namespace meshorder
