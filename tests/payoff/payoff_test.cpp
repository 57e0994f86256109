// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/procedural.hpp"
#include "mesh/stored_matrix.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/payoff.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using testing::HasSubstr;

constexpr auto kAssembly = static_cast<std::size_t>(Kernel::assembly);

Mesh scrambled_grid(Index size) {
  Mesh mesh = make_grid({.size = size});
  (void)reorder(mesh, {.methods = {"scrambled", "scrambled"}});
  return mesh;
}

TEST(PublicAdvise, SaysWhatAScrambledGridCouldGain) {
  const Mesh mesh = scrambled_grid(26);
  const Advice advice = advise(view(mesh));
  EXPECT_EQ(advice.as_is.vertices.name, "original");
  EXPECT_EQ(advice.as_is.order_seconds, 0);
  ASSERT_FALSE(advice.candidates.empty());
  EXPECT_FALSE(advice.as_is.costs.measured);
  const KernelAdvice& assembly = advice.kernels[kAssembly];
  const Candidate& best = advice.candidates[assembly.candidate];
  EXPECT_GT(assembly.gain.ratio, 1.5);
  EXPECT_DOUBLE_EQ(assembly.gain.ratio,
                   (*advice.as_is.costs.predicted)[kAssembly] / (*best.costs.predicted)[kAssembly]);
  EXPECT_GE(assembly.runs_to_pay, 1);
  EXPECT_GT(best.order_seconds, 0);
  EXPECT_LT(best.spans.mean_span, advice.as_is.spans.mean_span);
  const std::string verdict = to_string(advice);
  EXPECT_THAT(verdict, HasSubstr("times as long as it could"));
  EXPECT_THAT(verdict, HasSubstr("`meshorder order` takes"));
}

TEST(PublicAdvise, TakesArraysOfItsCaller) {
  const Mesh mesh = scrambled_grid(6);
  std::vector<std::array<float, 3>> points;
  for (const Point& p : mesh.points) {
    points.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
  std::vector<std::int64_t> tetrahedra;
  for (const Index v : mesh.cells.vertices) tetrahedra.push_back(v + 1);
  const MeshView arrays{.points = points, .cells = CellsView::uniform(Shape::tetrahedron, 4, tetrahedra, 1)};
  const Advice of_arrays = advise(arrays);
  const Advice of_mesh = advise(view(mesh));
  EXPECT_EQ(of_arrays.as_is.costs.predicted, of_mesh.as_is.costs.predicted);
  EXPECT_EQ(of_arrays.as_is.spans, of_mesh.as_is.spans);
}

/// A matrix on a lattice of side × side rows, in scrambled order. Each row has entries for itself, the next
/// row and the row below: the pattern is not symmetric.
struct ScrambledMatrix {
  explicit ScrambledMatrix(Index side) {
    const Index n = side * side;
    std::vector<Index> place(n);
    std::iota(place.begin(), place.end(), Index{0});
    std::ranges::shuffle(place, std::mt19937(1));
    std::vector<std::vector<Index>> rows(n);
    for (Index row = 0; row < n; ++row) {
      for (const Index column : {row, row + 1, row + side})
        if (column < n) rows[place[row]].push_back(place[column]);
    }
    for (const std::vector<Index>& row : rows) {
      columns.insert(columns.end(), row.begin(), row.end());
      starts.push_back(static_cast<Index>(columns.size()));
    }
  }
  [[nodiscard]] GraphView view() const { return {.offsets = starts, .neighbours = columns}; }

  std::vector<Index> starts{0};
  std::vector<Index> columns;
};

TEST(PublicAdvise, JudgesAMatrixByItsOwnProductAlone) {
  const ScrambledMatrix matrix(250);
  const Advice advice = advise(matrix.view(), {.machine = "zen3"});
  EXPECT_TRUE(advice.is_matrix);
  const KernelMilliseconds& times = *advice.as_is.costs.predicted;
  EXPECT_GT(times[0], 0);
  EXPECT_THAT(std::vector(times.begin() + 1, times.end()), testing::Each(0));
  EXPECT_GT(advice.kernels[0].gain.ratio, 1.5);
  EXPECT_THAT(to_string(advice), HasSubstr("products"));
  // the reference: the same entries as a file reader gives them
  const Mesh mesh = matrix_mesh(matrix.view());
  EXPECT_EQ(entry_pattern(mesh).entries(), static_cast<Offset>(matrix.columns.size()));
  EXPECT_EQ(meshorder::advise(mesh, {.machine = "zen3"}).as_is.costs.predicted, advice.as_is.costs.predicted);
  EXPECT_FALSE(meshorder::advise(view(mesh), {.machine = "zen3"}).is_matrix) << "lines alone are a mesh";
}

TEST(PublicCompare, MeasuresTheProductOfAMatrix) {
  const ScrambledMatrix matrix(20);
  const std::vector<Candidate> orders = compare(
      matrix.view(), {.methods = {{"rcm", "auto"}}, .predict = false, .measure = true, .budget_seconds = 0});
  ASSERT_EQ(orders.size(), 2U);
  EXPECT_GT((*orders[1].costs.measured)[0], 0);
  EXPECT_EQ((*orders[1].costs.measured)[1], 0);
  EXPECT_LT(orders[1].spans.mean_span, orders[0].spans.mean_span);
}

TEST(PublicAdvise, RefusesFaultyMatrices) {
  const std::vector<Index> starts{0, 1, 2};
  const auto of = [&](std::vector<Index> columns) {
    (void)advise(GraphView{.offsets = starts, .neighbours = columns});
  };
  EXPECT_THROW(of({0, 1}), InvalidArgument) << "the diagonal alone";
  EXPECT_THROW(of({0, 2}), InvalidArgument);
  EXPECT_THROW(of({1}), InvalidArgument);
  EXPECT_THROW((void)advise(ScrambledMatrix(4).view(), {.methods = {{"hilbert", "auto"}}}), InvalidArgument);
  EXPECT_THROW((void)advise(GraphView{}), InvalidArgument);
}

TEST(PublicAdvise, PredictsTheSameOnAnyNumberOfThreads) {
  const Mesh mesh = scrambled_grid(18);
  const Advice one = advise(view(mesh), {.order = {.run = {.threads = 1}}});
  const Advice two = advise(view(mesh), {.order = {.run = {.threads = 2}}});
  ASSERT_EQ(one.candidates.size(), two.candidates.size());
  EXPECT_EQ(one.as_is.costs.predicted, two.as_is.costs.predicted);
  EXPECT_EQ(one.candidates.front().costs.predicted, two.candidates.front().costs.predicted);
}

TEST(PublicAdvise, MeasuresOnAllThreadsWithoutACalibrationButDoesNotPredict) {
  const Mesh mesh = make_grid({.size = 6});
  PayoffOptions options{.machine = "zen3", .all_threads = true, .order = {.run = {.threads = 2}}};
  EXPECT_THROW((void)advise(view(mesh), options), InvalidArgument);
  options.predict = false;
  options.measure = true;
  options.budget_seconds = 0;
  const Advice advice = advise(view(mesh), options);
  EXPECT_EQ(advice.threads, 2);
  EXPECT_TRUE(advice.as_is.costs.measured);
  EXPECT_EQ(advice.machine, "");
}

TEST(PublicAdvise, HasNothingToSayForTheOrderThatItAdvises) {
  Mesh mesh = scrambled_grid(16);
  (void)reorder(mesh);
  EXPECT_THAT(to_string(advise(view(mesh))), HasSubstr("nothing to gain"));
}

TEST(PublicCompare, ListsTheMeshAsItIsAndThenWhatWasAskedFor) {
  const Mesh mesh = scrambled_grid(8);
  const std::vector<Candidate> candidates = compare(
      view(mesh),
      {.methods = {{"fiedler", "fiedler"}, {"original", "original"}, {"auto", "auto"}}, .predict = true});
  ASSERT_EQ(candidates.size(), 4U);
  EXPECT_EQ(candidates[0].vertices.name, "original");
  EXPECT_EQ(candidates[1].vertices.name, "fiedler");
  EXPECT_EQ(candidates[1].elements.name, "fiedler");
  EXPECT_EQ(candidates[2].costs.predicted, candidates[0].costs.predicted);
  EXPECT_EQ(candidates[2].spans, candidates[0].spans);
  EXPECT_EQ(candidates[2].pattern, candidates[0].pattern);
  EXPECT_NE(candidates[1].pattern, candidates[0].pattern);
  EXPECT_EQ(candidates[1].pattern.side, kPatternSide);
  EXPECT_EQ(candidates[2].order_seconds, 0);
  EXPECT_NE(candidates[3].vertices.name, "auto");
  EXPECT_FALSE(candidates[3].vertices.reason.empty());
}

TEST(PublicCompare, MeasuresWhereItIsAskedTo) {
  const Mesh mesh = scrambled_grid(4);
  const std::vector<Candidate> candidates = compare(
      view(mesh), {.methods = {{"rcm", "auto"}}, .predict = false, .measure = true, .budget_seconds = 0});
  for (const Candidate& candidate : candidates) {
    EXPECT_FALSE(candidate.costs.predicted);
    ASSERT_TRUE(candidate.costs.measured);
    EXPECT_GT(*std::min_element(candidate.costs.measured->begin(), candidate.costs.measured->end()), 0);
  }
}

TEST(PublicAdvise, RefusesWhatCannotBeAdvisedOn) {
  const Mesh mesh = make_grid({.size = 3});
  EXPECT_THROW((void)advise(MeshView{}), InvalidArgument);
  EXPECT_THROW((void)advise(view(mesh), {.predict = false}), InvalidArgument);
  EXPECT_THROW((void)advise(view(mesh), {.budget_seconds = -1}), InvalidArgument);
  EXPECT_THROW((void)advise(view(mesh), {.methods = {{"nonsense", "auto"}}}), InvalidArgument);
  Mesh broken = mesh;
  broken.points.front()[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)advise(view(broken)), InvalidArgument);
  broken = mesh;
  broken.cells.vertices.front() = mesh.vertex_count();
  EXPECT_THROW((void)advise(view(broken)), InvalidArgument);
  Mesh of_points;
  of_points.points = {{0, 0, 0}, {1, 0, 0}};
  of_points.cells.push_back(Shape::vertex, std::array<Index, 1>{1});
  EXPECT_THROW((void)advise(view(of_points)), InvalidArgument);
}

TEST(PublicAdvise, EndsWhenItsProgressFunctionSaysSo) {
  const Mesh mesh = scrambled_grid(40);
  std::vector<std::string> stages;
  const meshorder::Run run{.threads = 1, .progress = [&](const Progress& progress) {
                             if (stages.empty() || stages.back() != progress.stage)
                               stages.emplace_back(progress.stage);
                             return progress.stage != "predict";
                           }};
  EXPECT_THROW((void)advise(view(mesh), {.order = {.run = run}}), Stopped);
  EXPECT_EQ(stages.back(), "predict");
}

TEST(PublicKernel, HasAName) {
  for (const Kernel kernel : kKernels) EXPECT_FALSE(to_string(kernel).empty());
  EXPECT_EQ(to_string(Kernel::assembly), "assembly");
}

}  // namespace
}  // namespace meshorder
