// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/method.hpp"
#include "support/graph_views.hpp"
#include "support/refusal.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace meshorder {
namespace {
using test::refusal;

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A graph with random numbering, and random points that floats represent exactly.
struct Problem {
  CsrGraph graph;
  std::vector<Point> points;

  explicit Problem(const CsrGraph& ordered)
      : graph(renumbered(ordered, test::shuffled(ordered.size(), 11).old_to_new())) {
    std::mt19937_64 random(4);
    for (Index v = 0; v < graph.size(); ++v) {
      Point& point = points.emplace_back();
      for (double& x : point) x = static_cast<double>(random() % 4096U) / 8;
    }
  }

  [[nodiscard]] GraphView view() const { return test::view_of(graph); }
};

Problem components() {
  return Problem(test::disjoint_union(
      {test::grid(9, 7), test::path(1), test::star(20), test::cycle(70), test::path(1)}));
}

std::vector<std::string> names_of(const std::vector<MethodInfo>& methods) {
  std::vector<std::string> names;
  names.reserve(methods.size());
  for (const MethodInfo& method : methods) names.push_back(method.name);
  return names;
}

TEST(OrderVertices, IsTheSameForAllIntegerTypesAndBases) {
  const Problem problem = components();
  const test::CallersGraph<std::int32_t, std::int64_t> ints(problem.graph, 0);
  const test::CallersGraph<std::int64_t, std::int32_t> ours(problem.graph, 1);
  const test::CallersGraph<std::uint64_t, std::uint64_t> unsigned_ones(problem.graph, 0);
  const test::CallersGraph<std::uint32_t, std::uint32_t> narrow(problem.graph, 1);
  for (const std::string& method : names_of(vertex_methods())) {
    SCOPED_TRACE(method);
    const Permutation expected = order_graph(method, {problem.graph, problem.points}).permutation;
    for (const GraphView& view :
         {problem.view(), ints.view(), ours.view(), unsigned_ones.view(), narrow.view()}) {
      const Order order = order_vertices(view, method, {}, problem.points);
      EXPECT_EQ(order.permutation, expected);
      EXPECT_GE(order.seconds, 0);
      EXPECT_TRUE(order.complete);
    }
  }
  EXPECT_THAT(order_vertices(problem.view(), "rcm").notes, ElementsAre());
  EXPECT_THAT(order_vertices(ours.view(), "rcm").notes,
              ElementsAre("offsets copied to count from 0", "indices copied to count from 0"));
  EXPECT_THAT(order_vertices(ints.view(), "rcm").notes, ElementsAre("offsets widened", "indices narrowed"));
}

TEST(OrderVertices, IsTheSameForAllLayoutsOfThePoints) {
  const Problem problem(test::grid(9, 8));
  const auto n = problem.points.size();
  std::vector<float> padded(5 * n, -1);
  std::vector<double> columns(3 * n);  // all z, then all y, then all x
  std::vector<Point> backwards(problem.points.rbegin(), problem.points.rend());
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t a = 0; a < 3; ++a) {
      padded[5 * p + a] = static_cast<float>(problem.points[p][a]);
      columns[(2 - a) * n + p] = problem.points[p][a];
    }
  }
  const auto column = static_cast<Offset>(n * sizeof(double));
  const std::array<PointsView, 3> layouts{
      PointsView(padded.data(), n, 3, 5 * sizeof(float), sizeof(float)),
      PointsView(columns.data() + 2 * n, n, 3, sizeof(double), -column),
      PointsView(backwards.back().data(), n, 3, -Offset{sizeof(Point)}, sizeof(double))};
  for (const char* method : {"hilbert", "morton", "auto"}) {
    SCOPED_TRACE(method);
    const Permutation expected = order_graph(method, {problem.graph, problem.points}).permutation;
    for (const PointsView& points : layouts) {
      EXPECT_EQ(order_vertices(problem.view(), method, {}, points).permutation, expected);
    }
  }
}

TEST(OrderVertices, DoesNotDependOnTheNumberOfThreads) {
  const Problem problem(test::grid(120, test::large(100)));
  for (const std::string& method : names_of(vertex_methods())) {
    SCOPED_TRACE(method);
    const Order expected = order_vertices(problem.view(), method, {.run = {.threads = 1}}, problem.points);
    for (const int threads : {2, 4, 0, std::numeric_limits<int>::max()}) {
      const Order order =
          order_vertices(problem.view(), method, {.run = {.threads = threads}}, problem.points);
      EXPECT_EQ(order.permutation, expected.permutation) << threads << " threads";
      EXPECT_EQ(order.vector, expected.vector);
      EXPECT_EQ(order.fiedler, expected.fiedler);
    }
  }
}

TEST(OrderVertices, CleansLoopsRepeatsAndUnsortedRows) {
  const Problem problem = components();
  CsrGraph unsorted = problem.graph;
  CsrGraph messy;
  for (Index v = 0; v < problem.graph.size(); ++v) {
    std::reverse(unsorted.neighbours.begin() + unsorted.offsets[v],
                 unsorted.neighbours.begin() + unsorted.offsets[v + 1]);
    for (const Index u : unsorted[v]) messy.neighbours.insert(messy.neighbours.end(), {u, u});
    messy.neighbours.push_back(v);
    messy.offsets.push_back(static_cast<Offset>(messy.neighbours.size()));
  }
  const std::string loops = std::to_string(messy.size()) + " loops dropped";
  const std::string repeats = std::to_string(problem.graph.neighbours.size()) + " repeated entries merged";
  for (const std::string& method : names_of(vertex_methods())) {
    SCOPED_TRACE(method);
    const Permutation expected = order_vertices(problem.view(), method, {}, problem.points).permutation;
    const Order sorted = order_vertices(test::view_of(unsorted), method, {}, problem.points);
    EXPECT_EQ(sorted.permutation, expected);
    EXPECT_THAT(sorted.notes, ElementsAre("rows sorted"));
    const Order cleaned = order_vertices(test::view_of(messy), method, {}, problem.points);
    EXPECT_EQ(cleaned.permutation, expected);
    EXPECT_THAT(cleaned.notes, ElementsAre(loops, repeats));
  }
}

TEST(OrderVertices, RefusesAsymmetryUnlessItIsToBeMirrored) {
  const std::vector<Offset> offsets{0, 1, 3, 4};
  const std::vector<Index> neighbours{1, 0, 2, 0};  // row 2 names 0 in place of 1
  const GraphView view{offsets, neighbours};
  EXPECT_EQ(refusal([&] { (void)order_vertices(view, "rcm"); }),
            "graph: row 2 has the neighbour 0, but row 0 lacks 2; a graph has each edge in the rows of both "
            "its ends (Symmetry::mirror adds them)");
  EXPECT_EQ(order_vertices(view, "rcm", {.check = Check::fast}).permutation.size(), 3);
  const Order mirrored = order_vertices(view, "rcm", {.symmetry = Symmetry::mirror});
  EXPECT_EQ(mirrored.permutation, order_vertices(test::view_of(test::complete(3)), "rcm").permutation);
  EXPECT_THAT(mirrored.notes, ElementsAre("asymmetric pattern mirrored"));

  const std::vector<double> weights{1, 2, 3, 3};
  const std::vector<Index> symmetric{1, 0, 2, 1};
  EXPECT_THAT(refusal([&] {
                (void)order_vertices({offsets, symmetric, weights}, "fiedler");
              }),
              HasSubstr("the weight from 0 to 1 is 1, the weight back is 2"));
}

TEST(OrderVertices, KeepsGroupsTogether) {
  const Problem problem(test::grid(12, 10));
  const std::array<std::int64_t, 3> values{-5, 7, std::int64_t{1} << 40U};
  std::vector<std::int64_t> groups;
  for (Index v = 0; v < problem.graph.size(); ++v) groups.push_back(values[(v / 17) % 3]);
  for (const std::string& method : names_of(vertex_methods())) {
    SCOPED_TRACE(method);
    const Order order = order_vertices(problem.view(), method, {.groups = groups}, problem.points);
    const auto new_to_old = order.permutation.new_to_old();
    EXPECT_TRUE(std::is_sorted(new_to_old.begin(), new_to_old.end(),
                               [&](Index a, Index b) { return groups[a] < groups[b]; }));
  }
  EXPECT_THAT(
      refusal([&] { (void)order_vertices(problem.view(), "rcm", {.groups = IndexView(groups.data(), 7)}); }),
      HasSubstr("groups: 7 numbers for 120 vertices"));
}

TEST(OrderVertices, OrdersAGroupOfAllVerticesAsIfThereWereNone) {
  const Problem problem(test::grid(11, 10));
  std::vector<double> weights;
  for (Index v = 0; v < problem.graph.size(); ++v) {
    for (const Index u : problem.graph[v]) weights.push_back(1.0 + ((u + v) % 5) * 3.0);
  }
  const GraphView weighted{problem.graph.offsets, problem.graph.neighbours, weights};
  const std::vector<int> groups(problem.points.size(), 3);
  const Order alone = order_vertices(weighted, "fiedler");
  ASSERT_NE(alone.permutation, order_vertices(problem.view(), "fiedler").permutation);
  const OrderOptions options{.start = alone.vector, .groups = groups};
  const Order grouped = order_vertices(weighted, "fiedler", options);
  const Order again = order_vertices(weighted, "fiedler", {.start = alone.vector});
  EXPECT_EQ(grouped.permutation, again.permutation);
  EXPECT_EQ(grouped.vector, again.vector);
  EXPECT_EQ(grouped.fiedler, again.fiedler);
  EXPECT_FALSE(
      order_vertices(problem.view(), "minla", {.groups = groups, .run = {.time_limit = 0}}).complete);
}

TEST(OrderVertices, StartsFromAnEarlierVector) {
  const Problem problem(test::grid(90, 60));
  const OrderOptions accurate{.tolerance = 1e-6};
  const Order first = order_vertices(problem.view(), "fiedler", accurate);
  ASSERT_EQ(first.vector.size(), problem.points.size());
  OrderOptions from_there = accurate;
  from_there.start = first.vector;
  const Order second = order_vertices(problem.view(), "fiedler", from_there);
  EXPECT_GT(first.fiedler.front().iterations, second.fiedler.front().iterations);
  EXPECT_TRUE(second.fiedler.front().converged);
  const std::vector<float> narrow(first.vector.begin(), first.vector.end());
  from_there.start = narrow;
  EXPECT_GT(first.fiedler.front().iterations,
            order_vertices(problem.view(), "fiedler", from_there).fiedler.front().iterations);
}

TEST(OrderVertices, ChoosesByTheUse) {
  Problem problem(test::grid(20, 20));
  const Permutation places = test::shuffled(400, 11);  // the numbering that Problem uses
  for (Index v = 0; v < 400; ++v) {
    problem.points[places.old_to_new()[v]] = {1.0 * (v % 20), 1.0 * (v / 20), 0};
  }
  const auto chosen = [&](Workload workload, const PointsView& points) {
    return order_vertices(problem.view(), "auto", {.workload = workload}, points).method;
  };
  EXPECT_EQ(chosen(Workload::bandwidth, problem.points).name, "rcm");
  EXPECT_EQ(chosen(Workload::all, problem.points).name, "bfs");  // the graph is a lattice
  EXPECT_EQ(chosen(Workload::all, {}).name, "bfs");
  EXPECT_FALSE(chosen(Workload::all, {}).reason.empty());
  EXPECT_EQ(order_vertices(problem.view(), "rcm").method, (MethodChoice{"rcm", ""}));
  const auto known = names_of(vertex_methods());
  if (std::find(known.begin(), known.end(), "metis-nd") != known.end()) {
    EXPECT_EQ(chosen(Workload::fill, problem.points).name, "metis-nd");
  }
}

TEST(OrderVertices, RefusesUnknownMethodsAndListsTheKnownOnes) {
  const Problem problem(test::path(3));
  const std::string sentence = refusal([&] { (void)order_vertices(problem.view(), "best"); });
  EXPECT_THAT(sentence, HasSubstr("'best'"));
  for (const std::string& name : names_of(vertex_methods())) EXPECT_THAT(sentence, HasSubstr(name));
  EXPECT_THAT(refusal([&] { (void)order_vertices(problem.view(), "hilbert"); }),
              HasSubstr("needs the coordinates of all 3 vertices (points), got none"));
}

TEST(OrderVertices, LeavesTheArgumentsAsTheyAre) {
  const Problem problem = components();
  const Problem copy = problem;
  for (const std::string& method : names_of(vertex_methods())) {
    (void)order_vertices(problem.view(), method, {.symmetry = Symmetry::mirror}, problem.points);
    EXPECT_EQ(problem.graph, copy.graph) << method;
    EXPECT_EQ(problem.points, copy.points) << method;
  }
}

TEST(OrderVertices, RefusesOptionsOutOfRange) {
  const Problem problem(test::grid(5, 4));
  const auto refused = [&](const OrderOptions& options) {
    return refusal([&] { (void)order_vertices(problem.view(), "fiedler", options); });
  };
  const std::vector<double> bad_start(20, kNan);
  EXPECT_THAT(refused({.tolerance = 0}), HasSubstr("tolerance"));
  EXPECT_THAT(refused({.tolerance = kNan}), HasSubstr("tolerance"));
  EXPECT_THAT(refused({.max_iterations = 0}), HasSubstr("max_iterations"));
  EXPECT_THAT(refused({.start = RealView(bad_start.data(), 3)}), HasSubstr("3 entries for 20 vertices"));
  EXPECT_THAT(refused({.start = bad_start}), HasSubstr("not finite"));
  EXPECT_THAT(refused({.run = {.threads = -1}}), HasSubstr("threads"));
  EXPECT_THAT(refused({.run = {.time_limit = -1}}), HasSubstr("time limit"));
  EXPECT_THAT(refused({.run = {.time_limit = kNan}}), HasSubstr("time limit"));
  EXPECT_EQ(refused({.run = {.time_limit = 1e300}}), "");
}

TEST(OrderVertices, RefusesPointsThatAreNotFinite) {
  const Problem problem(test::path(4));
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    std::vector<Point> points = problem.points;
    points[2][1] = bad;
    EXPECT_EQ(refusal([&] { (void)order_vertices(problem.view(), "hilbert", {}, points); }),
              "points: coordinate 1 of point 2 is not finite");
  }
}

TEST(OrderVertices, OrdersPointsAtTheEndsOfTheRange) {
  const Problem problem(test::path(4));
  constexpr double kMost = std::numeric_limits<double>::max();
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  const std::vector<Point> far{{kMost, 0, 0}, {-kMost, 0, 0}, {kMost / 2, 0, 0}, {-kMost / 2, 0, 0}};
  const std::vector<Point> near{{3 * kLeast, 0, 0}, {0, 0, 0}, {2 * kLeast, 0, 0}, {kLeast, 0, 0}};
  for (const char* method : {"hilbert", "morton"}) {
    for (const std::vector<Point>& points : {far, near}) {
      EXPECT_THAT(order_vertices(problem.view(), method, {}, points).permutation.new_to_old(),
                  ElementsAre(1, 3, 2, 0));
    }
  }
}

TEST(OrderVertices, OrdersNothingAndNextToNothing) {
  const std::vector<Point> one_point{{1, 2, 3}};
  const std::vector<int> one_offset{1};
  const std::vector<Offset> one_row{0, 0};
  for (const std::string& method : names_of(vertex_methods())) {
    SCOPED_TRACE(method);
    EXPECT_EQ(order_vertices({}, method).permutation.size(), 0);
    EXPECT_EQ(order_vertices({one_offset, {}, {}, 1}, method).permutation.size(), 0);
    EXPECT_EQ(order_vertices({one_row, {}}, method, {}, one_point).permutation, Permutation::identity(1));
  }
}

TEST(OrderVertices, RefusesSizesThatDoNotFit) {
  const Problem problem(test::path(4));
  const GraphView view = problem.view();
  const auto refused = [](const GraphView& graph) {
    return refusal([&] { (void)order_vertices(graph, "rcm"); });
  };
  EXPECT_THAT(refused({IndexView(problem.graph.offsets.data(), 4), view.neighbours}),
              HasSubstr("does not fit 6 neighbours"));
  const std::vector<float> weights(5, 1);
  EXPECT_THAT(refused({view.offsets, view.neighbours, weights}), HasSubstr("5 weights for 6 neighbours"));
  EXPECT_THAT(refused({view.offsets, view.neighbours, {}, 2}), HasSubstr("base"));
  EXPECT_THAT(
      refusal([&] { (void)order_vertices(view, "hilbert", {}, PointsView(problem.points[0].data(), 3)); }),
      HasSubstr("3 points for 4 vertices"));
}

// No array has these sizes. They are refused before anything is read.
TEST(OrderVertices, RefusesSizesBeyondItsIntegers) {
  const Problem problem(test::path(4));
  const std::size_t wrapped = (std::size_t{1} << 32U) + 4;  // 4 if truncated to 32 bits
  const std::array<int, 2> two{0, 0};
  const std::array<double, 2> numbers{};
  const GraphView huge{IndexView(two.data(), (std::size_t{1} << 31U) + 1), {}};
  EXPECT_THROW((void)order_vertices(huge, "rcm"), TooLarge);
  EXPECT_THROW((void)fiedler_vector(huge), TooLarge);
  EXPECT_THROW((void)order_vertices(problem.view(), "rcm", {.groups = IndexView(two.data(), wrapped)}),
               InvalidArgument);
  EXPECT_THROW((void)order_vertices(problem.view(), "fiedler", {.start = RealView(numbers.data(), wrapped)}),
               InvalidArgument);
  for (const Check check : {Check::full, Check::none}) {
    EXPECT_THROW((void)order_vertices(problem.view(), "hilbert", {.check = check},
                                      PointsView(numbers.data(), wrapped)),
                 InvalidArgument);
  }
  EXPECT_THROW((void)vertex_graph({}, std::size_t{1} << 31U), TooLarge);
  const CellsView many = CellsView::mixed(IndexView(two.data(), (std::size_t{1} << 31U) + 2), {});
  EXPECT_THROW((void)vertex_graph(many, 4), TooLarge);
  EXPECT_THROW((void)Permutation::from_old_to_new(IndexView(two.data(), wrapped)), TooLarge);
}

/// A mesh's cells in arrays of the caller's own types.
template <class OffsetType, class IndexType>
struct CallersCells {
  std::vector<OffsetType> offsets;
  std::vector<IndexType> vertices;

  CallersCells(const Mesh& mesh, int base) {
    for (const Offset offset : mesh.cells.offsets) offsets.push_back(static_cast<OffsetType>(offset + base));
    for (const Index v : mesh.cells.vertices) vertices.push_back(static_cast<IndexType>(v + base));
  }
};

TEST(DualGraph, JoinsPolyhedraOfVtkByThreeVertices) {
  const std::vector<std::int64_t> offsets{0, 6, 11, 15};
  const std::vector<std::int64_t> vertices{0, 1, 2, 3, 4, 5, 5, 4, 3, 6, 7, 7, 6, 8, 0};
  const std::vector<std::uint8_t> types{42, 42, 10};
  const Graph graph = dual_graph(CellsView::mixed(offsets, vertices, types), 9);
  EXPECT_THAT(graph.offsets(), ElementsAre(0, 1, 2, 2));
  EXPECT_THAT(graph.neighbours(), ElementsAre(1, 0));
}

TEST(OrderElements, IsTheSameForAllLayoutsOfTheCells) {
  const Mesh mesh = test::tetrahedral_bar(9);
  const Permutation vertices = test::shuffled(mesh.vertex_count(), 3);
  const CallersCells<std::int32_t, std::uint64_t> wide(mesh, 1);
  const CallersCells<std::int64_t, std::uint32_t> narrow(mesh, 0);
  const std::vector<std::uint8_t> vtk_types(static_cast<std::size_t>(mesh.cell_count()), 10);
  const std::array<CellBlock, 1> block{{{Shape::tetrahedron, 4, narrow.vertices}}};
  const std::array<CellsView, 5> layouts{
      CellsView::uniform(Shape::tetrahedron, 4, wide.vertices, 1), CellsView::blocks(block),
      CellsView::mixed(wide.offsets, wide.vertices, vtk_types, 1),
      CellsView::mixed(narrow.offsets, narrow.vertices, std::span<const Shape>(mesh.cells.shapes)),
      CellsView::mixed(mesh.cells.offsets, mesh.cells.vertices)};
  const CellsView plain = CellsView::uniform(Shape::tetrahedron, 4, mesh.cells.vertices);
  for (const std::string& method : names_of(element_methods())) {
    SCOPED_TRACE(method);
    const Permutation expected = order_elements(plain, vertices, method, {}, mesh.points).permutation;
    for (const CellsView& cells : layouts) {
      const bool has_shapes = !cells.is_mixed() || !cells.vtk_types().empty() || !cells.shapes().empty();
      if (method == "fiedler-facet" && !has_shapes) {
        EXPECT_THAT(refusal([&] { (void)order_elements(cells, vertices, method); }), HasSubstr("shapes"));
        continue;
      }
      for (const int threads : {1, 4}) {
        const OrderOptions options{.run = {.threads = threads}};
        EXPECT_EQ(order_elements(cells, vertices, method, options, mesh.points).permutation, expected);
      }
    }
  }
}

TEST(OrderElements, KeepsCellsInTheirBlockAndDimension) {
  const Mesh mesh = test::mixed_mesh();
  const CellsView cells =
      CellsView::mixed(mesh.cells.offsets, mesh.cells.vertices, std::span<const Shape>(mesh.cells.shapes));
  const Permutation vertices = test::shuffled(mesh.vertex_count(), 8);
  std::vector<Index> parity;
  for (Index c = 0; c < mesh.cell_count(); ++c) parity.push_back(-c % 2);
  for (const std::string& method : names_of(element_methods())) {
    SCOPED_TRACE(method);
    const Order order = order_elements(cells, vertices, method, {.cell_groups = parity}, mesh.points);
    ASSERT_EQ(order.permutation.size(), mesh.cell_count());
    std::array<Index, 4> last_group{-1, -1, -1, -1};
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      const Index old = order.permutation.new_to_old()[c];
      const int dimension_there = dimension(mesh.cells.shapes[c]);
      EXPECT_EQ(dimension(mesh.cells.shapes[old]), dimension_there);
      EXPECT_GE(parity[old], last_group[dimension_there]);
      last_group[dimension_there] = parity[old];
    }
  }
  const Mesh bar = test::tetrahedral_bar(4);
  const std::span<const Index> all = bar.cells.vertices;
  const std::array<CellBlock, 3> blocks{{{Shape::tetrahedron, 4, all.first(40)},
                                         {Shape::tetrahedron, 4, {}},
                                         {Shape::tetrahedron, 4, all.subspan(40)}}};
  const Permutation reversed =
      order_elements(CellsView::blocks(blocks), test::shuffled(bar.vertex_count(), 2), "lexmax").permutation;
  for (Index c = 0; c < bar.cell_count(); ++c) EXPECT_EQ(reversed.old_to_new()[c] < 10, c < 10);
  EXPECT_FALSE(reversed.is_identity());
  EXPECT_THAT(refusal([&] {
                (void)order_elements(cells, vertices, "min", {.cell_groups = IndexView(parity.data(), 1)});
              }),
              HasSubstr("groups: 1 numbers"));
}

TEST(OrderElements, RefusesFaultyCells) {
  const Permutation four = Permutation::identity(4);
  const auto refused = [&](const CellsView& cells) {
    return refusal([&] { (void)order_elements(cells, four, "lexmax"); });
  };
  const std::vector<int> tets{0, 1, 2, 3, 1, 2, 3, 4};
  EXPECT_EQ(refused(CellsView::uniform(Shape::tetrahedron, 4, tets)),
            "cells: entry 3 of cell 1 is 4, outside 0 … 3; if the numbers begin at 1, set the base to 1 or "
            "subtract 1");
  EXPECT_EQ(refused(CellsView::uniform(Shape::tetrahedron, 4, tets, 1)),
            "cells: entry 0 of cell 0 is 0, outside 1 … 4; if the numbers begin at 0, set the base to 0");
  const std::vector<std::uint64_t> far{0, 1, 2, 3, 1, 2, 7'000'000'000, 3};
  EXPECT_EQ(refused(CellsView::uniform(Shape::tetrahedron, 4, far)),
            "cells: entry 2 of cell 1 is 7000000000, outside 0 … 3");
  const std::array<CellBlock, 2> blocks{
      {{Shape::tetrahedron, 4, IndexView(far.data(), 4)}, {Shape::tetrahedron, 4, IndexView(&far[4], 4)}}};
  EXPECT_EQ(refused(CellsView::blocks(blocks)), "cells: entry 2 of cell 1 is 7000000000, outside 0 … 3");
  EXPECT_EQ(
      refusal([&] { (void)order_elements(CellsView::uniform(Shape::tetrahedron, 4, tets), {}, "lexmax"); }),
      "cells: entry 0 of cell 0 is 0, but there are no vertices");
  EXPECT_THAT(refused(CellsView::uniform(Shape::tetrahedron, 4, IndexView(tets.data(), 6))),
              HasSubstr("do not make cells of 4"));
  EXPECT_THAT(refused(CellsView::uniform(Shape::tetrahedron, 0, tets)), HasSubstr("cells of 0"));
  EXPECT_THAT(refused(CellsView::uniform(Shape::tetrahedron, 2, IndexView(tets.data(), 4))),
              HasSubstr("needs at least 4"));
  const std::vector<std::int64_t> offsets{0, 4};
  const IndexView first(tets.data(), 4);
  const std::vector<std::uint8_t> unknown_type{99};
  const std::vector<std::uint8_t> two_types{10, 10};
  EXPECT_THAT(refused(CellsView::mixed(offsets, first, unknown_type)), HasSubstr("VTK type 99"));
  EXPECT_THAT(refused(CellsView::mixed(offsets, first, two_types)), HasSubstr("2 types for 1 cells"));
  const std::vector<Shape> unknown_shape{static_cast<Shape>(200)};
  EXPECT_THAT(refused(CellsView::mixed(offsets, first, std::span<const Shape>(unknown_shape))),
              HasSubstr("the shape 200"));
  EXPECT_THAT(refused(CellsView::uniform(static_cast<Shape>(kShapes), 4, first)), HasSubstr("the shape 13"));
  EXPECT_THAT(refused(CellsView::mixed(offsets, first, two_types, 3)), HasSubstr("base"));
  const std::vector<std::int64_t> falling{0, 5, 4};
  const std::vector<int> voxel_offsets{0, 8};
  const std::vector<int> voxel{0, 1, 2, 9, 0, 1, 2, 3};
  const std::vector<std::uint8_t> voxel_type{11};
  EXPECT_THAT(refused(CellsView::mixed(falling, first)), HasSubstr("offset 2 is less"));
  EXPECT_EQ(refused(CellsView::mixed(offsets, tets)),
            "cells: the offsets go from 0 to 4; for 8 entries they must go from 0 to 8");
  EXPECT_EQ(refused(CellsView::mixed(offsets, tets, 1)),
            "cells: the offsets go from 0 to 4; for 8 entries they must go from 1 to 9");
  EXPECT_EQ(refused(CellsView::mixed(voxel_offsets, voxel, voxel_type)),
            "cells: entry 3 of cell 0 is 9, outside 0 … 3")
      << "the caller's entry, although corners 2 and 3 change places";
  EXPECT_THAT(refusal([&] { (void)order_elements({}, four, "best"); }), HasSubstr("'best'; known: auto"));
}

TEST(OrderElements, RefusesBlocksWhoseCellsHaveAnUnusualNumberOfVertices) {
  const Permutation vertices = Permutation::identity(1000);
  std::vector<int> numbers(1000);
  std::iota(numbers.begin(), numbers.end(), 0);
  const auto refused = [&](Shape shape, int width) {
    const CellsView cell = CellsView::uniform(shape, width, IndexView(numbers.data(), width));
    return refusal([&] { (void)order_elements(cell, vertices, "original"); });
  };
  EXPECT_EQ(refused(Shape::tetrahedron, 5),
            "cells: the cells of block 0 have 5 vertices; a tetrahedron has 4, 8, 10, 11, 14, 15, …");
  EXPECT_THAT(refused(Shape::triangle, 4), HasSubstr("a triangle has 3, 6, 7, 9, 10, 12, …"));
  EXPECT_THAT(refused(Shape::hexahedron, 10), HasSubstr("a hexahedron has 8, 9, 12, 16, 18, 20, …"));
  EXPECT_THAT(refused(Shape::vertex, 2), HasSubstr("a vertex has 1"));
  const std::vector<std::pair<Shape, std::vector<int>>> usual{
      {Shape::vertex, {1}},
      {Shape::line, {2, 3, 4, 11}},
      {Shape::triangle, {3, 6, 7, 9, 10, 12, 15, 21, 28, 36, 45, 55, 66}},
      {Shape::quad, {4, 5, 6, 8, 9, 12, 16, 20, 25, 36, 49, 64, 81, 100, 121}},
      {Shape::tetrahedron, {4, 8, 10, 11, 14, 15, 16, 20, 22, 35, 56, 84, 120, 165, 220, 286}},
      {Shape::pyramid, {5, 13, 14, 18, 19, 21, 30, 55, 91, 140, 204, 285, 385, 506}},
      {Shape::wedge, {6, 12, 15, 16, 18, 20, 21, 24, 40, 75, 126, 196, 288, 405, 550, 726}},
      {Shape::hexahedron, {8, 9, 12, 18, 20, 24, 27, 32, 64, 125, 216, 343, 512, 729, 1000}},
      {Shape::polygon, {5, 7, 13}},
      {Shape::polyhedron, {5, 7, 13}}};
  for (const auto& [shape, widths] : usual)
    for (const int width : widths) EXPECT_EQ(refused(shape, width), "") << width;

  const std::vector<int> offsets{0, 5};
  const std::vector<Shape> shapes{Shape::tetrahedron};
  const CellsView mixed = CellsView::mixed(offsets, IndexView(numbers.data(), 5), std::span(shapes));
  EXPECT_EQ(order_elements(mixed, vertices, "original").permutation.size(), 1) << "as files have them";
}

TEST(OrderEdges, GoesByTheLargerPlaceOfTheTwo) {
  const CsrGraph graph = test::random_connected(200, 500, 8);
  const Permutation vertices = test::shuffled(200, 3);
  std::vector<Index> ends;
  std::vector<std::tuple<Index, Index, Index>> expected;  // larger place, smaller place, edge
  for (Index v = 0; v < 200; ++v) {
    for (const Index u : graph[v]) {
      if (u > v) continue;
      const auto [low, high] = std::minmax(vertices.old_to_new()[u], vertices.old_to_new()[v]);
      expected.emplace_back(high, low, static_cast<Index>(expected.size()));
      ends.insert(ends.end(), {v, u});
    }
  }
  std::ranges::sort(expected);
  const Permutation order = order_edges(ends, vertices);
  ASSERT_EQ(order.size(), index_size(expected));
  for (Index k = 0; k < order.size(); ++k) EXPECT_EQ(order.new_to_old()[k], std::get<2>(expected[k]));
  EXPECT_EQ(order_edges({}, vertices).size(), 0);
  std::vector<Index> renumbered = ends;
  vertices.renumber(renumbered);
  EXPECT_EQ(order_edges(renumbered, Permutation::identity(200)), order);
  EXPECT_THAT(refusal([&] { (void)order_edges(std::span(ends).first(3), vertices); }),
              HasSubstr("two for each"));
  ends[5] = 200;
  EXPECT_THAT(refusal([&] { (void)order_edges(ends, vertices); }),
              HasSubstr("end 5 is 200, outside 0 … 199"));
}

TEST(OrderMesh, IsTheOrderOfTheVertexGraphAndThenOfTheElements) {
  const Mesh mesh = test::tetrahedral_bar(7);
  const CellsView cells = CellsView::uniform(Shape::tetrahedron, 4, mesh.cells.vertices);
  const Graph graph = vertex_graph(cells, static_cast<std::size_t>(mesh.vertex_count()));
  std::vector<int> groups;
  for (Index v = 0; v < mesh.vertex_count(); ++v) groups.push_back(v % 3);
  for (const std::string& method : names_of(vertex_methods())) {
    SCOPED_TRACE(method);
    for (const OrderOptions& options : {OrderOptions{}, OrderOptions{.groups = groups}}) {
      const MeshOrder order =
          order_mesh({.points = mesh.points, .cells = cells}, {method, "lexmax"}, options);
      const Order vertices = order_vertices(graph, method, options, mesh.points);
      EXPECT_EQ(order.vertices.permutation, vertices.permutation);
      EXPECT_EQ(order.vertices.method, vertices.method);
      EXPECT_EQ(order.cells.permutation, order_elements(cells, vertices.permutation, "lexmax").permutation);
    }
  }
  const MeshOrder automatic = order_mesh({.points = mesh.points, .cells = cells});
  EXPECT_EQ(automatic.vertices.method, order_vertices(graph, "auto", {}, mesh.points).method);
  EXPECT_EQ(automatic.cells.method,
            order_elements(cells, automatic.vertices.permutation, "auto", {}, mesh.points).method);
}

TEST(OrderMesh, TakesTheNumberOfVerticesFromThePoints) {
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {2, 1, 3}};
  const CellsView cells = CellsView::uniform(Shape::triangle, 3, triangles);
  EXPECT_EQ(order_mesh({.cells = cells, .vertex_count = 6}).vertices.permutation.size(), 6);
  const std::vector<std::array<float, 2>> plane{{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  const MeshOrder order = order_mesh({.points = plane, .cells = cells}, {"hilbert", "hilbert"});
  EXPECT_EQ(order.vertices.permutation.size(), 4);
  EXPECT_EQ(order.cells.permutation.size(), 2);
  EXPECT_THAT(refusal([&] { (void)order_mesh({.points = plane, .cells = cells, .vertex_count = 6}); }),
              HasSubstr("points: there are 4, but vertex_count is 6"));
  EXPECT_EQ(refusal([&] { (void)order_mesh({.cells = cells}); }),
            "cells: neither points nor vertex_count are given");
  EXPECT_EQ(order_mesh({}).cells.permutation.size(), 0);
}

/// How many numbers two cells have in common.
std::size_t shared(std::span<const Index> a, std::span<const Index> b) {
  return static_cast<std::size_t>(std::count_if(
      a.begin(), a.end(), [&](Index v) { return std::find(b.begin(), b.end(), v) != b.end(); }));
}

TEST(VertexGraph, JoinsTheVerticesOfEveryElement) {
  const Mesh mesh = test::tetrahedral_bar(3);
  const CellsView cells = CellsView::uniform(Shape::tetrahedron, 4, mesh.cells.vertices);
  const auto n = static_cast<std::size_t>(mesh.vertex_count()) + 2;  // two vertices that no cell uses
  std::vector<std::vector<Index>> rows(n);
  for (Index v = 0; v < index_size(rows); ++v) {
    for (Index u = 0; u < index_size(rows); ++u) {
      bool joined = false;
      for (Index c = 0; c < mesh.cell_count(); ++c) {
        const std::array<Index, 2> pair{u, v};
        joined = joined || (u != v && shared(pair, mesh.cells[c]) == 2);
      }
      if (joined) rows[v].push_back(u);
    }
  }
  for (const int threads : {1, 3}) {
    const Graph graph = vertex_graph(cells, n, {.threads = threads});
    check(graph);
    ASSERT_EQ(graph.size(), index_size(rows));
    for (std::size_t v = 0; v < n; ++v) {
      EXPECT_THAT(graph.neighbours().subspan(graph.offsets()[v], graph.offsets()[v + 1] - graph.offsets()[v]),
                  ElementsAreArray(rows[v]));
    }
  }
  EXPECT_THROW((void)vertex_graph(cells, 3), InvalidArgument);
}

TEST(DualGraph, JoinsElementsByFacetOrByVertex) {
  const Mesh mesh = test::tetrahedral_bar(3);
  const CellsView cells = CellsView::uniform(Shape::tetrahedron, 4, mesh.cells.vertices);
  const auto n = static_cast<std::size_t>(mesh.vertex_count());
  for (const bool by_facet : {true, false}) {
    const Graph graph = dual_graph(cells, n, by_facet);
    check(graph);
    ASSERT_EQ(graph.size(), mesh.cell_count());
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      std::vector<Index> expected;
      for (Index d = 0; d < mesh.cell_count(); ++d) {
        if (c != d && shared(mesh.cells[c], mesh.cells[d]) >= (by_facet ? 3U : 1U)) expected.push_back(d);
      }
      EXPECT_THAT(graph.neighbours().subspan(graph.offsets()[c], graph.offsets()[c + 1] - graph.offsets()[c]),
                  ElementsAreArray(expected));
    }
  }
  const CellsView shapeless = CellsView::mixed(mesh.cells.offsets, mesh.cells.vertices);
  EXPECT_THROW((void)dual_graph(shapeless, n), InvalidArgument);
  EXPECT_EQ(dual_graph(shapeless, n, false), dual_graph(cells, n, false));
  EXPECT_EQ(dual_graph({}, 5).size(), 0);
}

TEST(FiedlerVector, IsTheCosineOfAPath) {
  constexpr Index kSize = 300;
  const CsrGraph path = test::path(kSize);
  const Fiedler fiedler = fiedler_vector(test::view_of(path), {.tolerance = 1e-9});
  ASSERT_EQ(fiedler.values.size(), std::size_t{kSize});
  ASSERT_EQ(fiedler.components.size(), 1U);
  EXPECT_TRUE(fiedler.components[0].converged);
  EXPECT_TRUE(fiedler.complete);
  const double angle = std::numbers::pi / kSize;
  EXPECT_NEAR(fiedler.components[0].lambda2, 2 - 2 * std::cos(angle), 1e-12);
  for (Index v = 0; v < kSize; ++v) {
    EXPECT_NEAR(fiedler.values[v], -std::sqrt(2.0 / kSize) * std::cos(angle * (v + 0.5)), 1e-6);
  }
}

TEST(FiedlerVector, ReportsComponentsLargestFirst) {
  const CsrGraph graph =
      test::disjoint_union({test::path(3), test::path(1), test::grid(10, 9), test::path(3)});
  const test::CallersGraph<int, std::int64_t> callers(graph, 1);
  const Fiedler fiedler = fiedler_vector(callers.view());
  ASSERT_EQ(fiedler.components.size(), 4U);
  EXPECT_EQ(fiedler.components[0].size, 90);
  EXPECT_EQ(fiedler.components[3].size, 1);
  EXPECT_NEAR(fiedler.components[1].lambda2, 1, 1e-9);
  EXPECT_THAT(fiedler.notes, ElementsAre("offsets widened", "indices narrowed"));
  EXPECT_EQ(fiedler.component_of[0], 1);
  EXPECT_EQ(fiedler.component_of[3], 3);
  EXPECT_EQ(fiedler.component_of[4], 0);
  EXPECT_EQ(fiedler.component_of.back(), 2);
  EXPECT_EQ(fiedler.values[3], 0);
  std::array<double, 4> sums{};
  std::array<double, 4> squares{};
  for (Index v = 0; v < graph.size(); ++v) {
    sums[fiedler.component_of[v]] += fiedler.values[v];
    squares[fiedler.component_of[v]] += fiedler.values[v] * fiedler.values[v];
  }
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_NEAR(sums[c], 0, 1e-9);
    EXPECT_NEAR(squares[c], c < 3 ? 1 : 0, 1e-12);
  }
}

TEST(FiedlerVector, FollowsTheWeights) {
  // a path of three whose first edge has weight w: λ₂ = 1 + w − √(1 − w + w²)
  const CsrGraph path = test::path(3);
  for (const double w : {0.25, 1.0, 7.0}) {
    const std::vector<double> weights{w, w, 1, 1};
    const Fiedler fiedler = fiedler_vector({path.offsets, path.neighbours, weights});
    EXPECT_NEAR(fiedler.components[0].lambda2, 1 + w - std::sqrt(1 - w + w * w), 1e-12);
  }
  EXPECT_TRUE(fiedler_vector({}).values.empty());
}

TEST(FiedlerVector, HasNumbersEvenWhereTheWeightsOverflow) {
  const CsrGraph grid = test::grid(12, 11);
  const std::vector<double> weights(grid.neighbours.size(), std::numeric_limits<double>::max());
  const Fiedler fiedler = fiedler_vector({grid.offsets, grid.neighbours, weights});
  for (const double value : fiedler.values) EXPECT_TRUE(std::isfinite(value));
  const std::vector<double> tiny(grid.neighbours.size(), std::numeric_limits<double>::denorm_min());
  for (const double value : fiedler_vector({grid.offsets, grid.neighbours, tiny}).values) {
    EXPECT_TRUE(std::isfinite(value));
  }
}

/// A grid of triangles with random vertex numbers, and its points. Squares are cut along either diagonal, so
/// that `auto` does not treat the grid as a lattice.
struct Sheet {
  static constexpr Index kSide = 30;
  std::vector<Point> points{static_cast<std::size_t>(kSide * kSide)};
  std::vector<std::array<Index, 3>> triangles;

  Sheet() {
    const Permutation numbers = test::shuffled(kSide * kSide, 3);
    const auto at = [&](Index x, Index y) { return numbers.old_to_new()[x + kSide * y]; };
    for (Index y = 0; y < kSide; ++y) {
      for (Index x = 0; x < kSide; ++x) {
        points[at(x, y)] = {static_cast<double>(x), static_cast<double>(y), 0.1 * x};
        if (x + 1 == kSide || y + 1 == kSide) continue;
        const bool rises = (x * x + 3 * x * y + 5 * y) % 7 < 3;
        const Index first = rises ? at(x, y) : at(x + 1, y);
        const Index second = rises ? at(x + 1, y + 1) : at(x, y + 1);
        triangles.push_back({first, second, rises ? at(x + 1, y) : at(x, y)});
        triangles.push_back({first, second, rises ? at(x, y + 1) : at(x + 1, y + 1)});
      }
    }
  }
};

TEST(OrderMesh, NoticesTransposedPoints) {
  const Sheet sheet;
  const CellsView cells = CellsView::uniform(Shape::triangle, 3, sheet.triangles);
  const Order right = order_mesh({sheet.points, cells}).vertices;
  EXPECT_THAT(right.notes, testing::IsEmpty());
  std::vector<double> by_axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Point& point : sheet.points) by_axes.push_back(point[axis]);
  }
  const PointsView misread(by_axes, 3);
  const Order by_auto = order_mesh({misread, cells}).vertices;
  EXPECT_NE(by_auto.method, right.method);
  EXPECT_THAT(
      by_auto.notes,
      ElementsAre("neighbours are as far apart as any two points, so auto does not use the coordinates: "
                  "is an array transposed, or of another mesh?"));
  EXPECT_EQ(by_auto.permutation, order_mesh({{}, cells, sheet.points.size()}).vertices.permutation)
      << "does not go by the coordinates";
  const Order named = order_mesh({misread, cells}, {.vertices = "hilbert"}).vertices;
  EXPECT_EQ(named.method.name, "hilbert") << "but where it is asked to";
  EXPECT_THAT(named.notes, ElementsAre("neighbours are as far apart as any two points: is an array "
                                       "transposed, or of another mesh?"));
  const auto points = static_cast<Offset>(sheet.points.size()) * Offset{sizeof(double)};
  const PointsView well_read(by_axes.data(), sheet.points.size(), 3, Offset{sizeof(double)}, points);
  EXPECT_EQ(order_mesh({well_read, cells}).vertices.permutation, right.permutation);
}

TEST(OrderMesh, NoticesTransposedCells) {
  Sheet sheet;
  test::shuffled(static_cast<Index>(sheet.triangles.size()), 5).move_in_place(std::span(sheet.triangles));
  std::vector<Index> by_corners;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (const auto& triangle : sheet.triangles) by_corners.push_back(triangle[corner]);
  }
  const CellsView cells = CellsView::uniform(Shape::triangle, 3, by_corners);
  EXPECT_THAT(order_mesh({sheet.points, cells}).vertices.notes,
              ElementsAre(HasSubstr("neighbours are as far apart as any two points")));
}

TEST(OrderVertices, NoticesPointsOfAnotherGraph) {
  const Sheet sheet;
  const Graph graph =
      vertex_graph(CellsView::uniform(Shape::triangle, 3, sheet.triangles), sheet.points.size());
  EXPECT_THAT(order_vertices(graph, "hilbert", {}, sheet.points).notes, testing::IsEmpty());
  std::vector<Point> others = sheet.points;
  test::shuffled(Sheet::kSide * Sheet::kSide, 8).move_in_place(std::span(others));
  EXPECT_THAT(order_vertices(graph, "hilbert", {}, others).notes, ElementsAre(HasSubstr("of another mesh")));
  const std::vector<Point> all_in_one(sheet.points.size());
  EXPECT_THAT(order_vertices(graph, "hilbert", {}, all_in_one).notes, testing::IsEmpty());
  EXPECT_THAT(order_vertices(graph, "rcm", {}, others).notes, testing::IsEmpty()) << "does not go by them";
}

}  // namespace
}  // namespace meshorder
