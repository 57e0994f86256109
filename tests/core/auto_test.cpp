// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/csr_graph.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include "ordering/judgement.hpp"
#include "ordering/method.hpp"
#include "ordering/moved.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// A grid graph on the points of its lattice, row after row or in a random order.
struct Lattice {
  CsrGraph graph = test::grid(30, 40);
  std::vector<Point> points;

  explicit Lattice(bool scrambled = true) {
    for (Index v = 0; v < graph.size(); ++v) points.push_back({1.0 * (v % 30), 1.0 * (v / 30), 0.0});
    if (!scrambled) return;
    const Permutation places = test::shuffled(graph.size(), 1);
    graph = renumbered(graph, places.old_to_new());
    points = moved(places, points);
  }
};

OrderOptions options_for(Workload use) {
  OrderOptions options;
  options.workload = use;
  return options;
}

bool is_known(const std::string& name) {
  const auto methods = vertex_methods();
  return std::any_of(methods.begin(), methods.end(), [&](const MethodInfo& m) { return m.name == name; });
}

TEST(Auto, GivesTheOrderOfTheMethodThatItSaysItTook) {
  const Lattice lattice;
  for (const Workload use : kWorkloads) {
    SCOPED_TRACE(to_string(use));
    for (const std::span<const Point> points :
         {std::span<const Point>(lattice.points), std::span<const Point>()}) {
      const VertexInput problem{lattice.graph, points};
      const Order order = order_graph("auto", problem, options_for(use));
      EXPECT_TRUE(is_known(order.method.name)) << order.method.name;
      EXPECT_NE(order.method.name, "auto");
      EXPECT_FALSE(order.method.reason.empty());
      EXPECT_EQ(order.method, choose_vertex_method(problem, use));
      EXPECT_EQ(order.permutation, order_graph(order.method.name, problem).permutation);
    }
  }
}

TEST(Auto, LeavesVerticesWithoutNeighboursInTheirPlacesWhereItKeepsTheOrder) {
  const CsrGraph graph = test::disjoint_union({test::path(1), test::path(40), test::path(1), test::path(3)});
  for (const Workload use : {Workload::all, Workload::spmv, Workload::bandwidth}) {
    const Order order = order_graph("auto", {graph, {}}, options_for(use));
    ASSERT_EQ(order.method.name, "original");
    EXPECT_TRUE(order.permutation.is_identity());
  }
}

TEST(Auto, KeepsAnOrderThatItWouldNotMakeBetter) {
  const Lattice in_rows(false);
  for (const Workload use : kWorkloads) {
    if (use == Workload::fill) continue;
    SCOPED_TRACE(to_string(use));
    const Order order = order_graph("auto", {in_rows.graph, in_rows.points}, options_for(use));
    EXPECT_EQ(order.method.name, "original");
    EXPECT_TRUE(order.permutation.is_identity());
    EXPECT_THAT(order.method.reason, testing::HasSubstr("is no better: t"));
  }
  // a method that the user names is applied all the same
  EXPECT_FALSE(order_graph("hilbert", {in_rows.graph, in_rows.points}).permutation.is_identity());
}

TEST(Auto, JudgesByTheUse) {
  const CsrGraph graph = test::grid(40, 30);
  const Permutation as_is = Permutation::identity(graph.size());
  // in rows of 40 the bandwidth is 40, in columns of 30 it would be 30
  const Permutation columns = order_graph("rcm", {graph, {}}).permutation;
  EXPECT_EQ(reason_to_keep(graph, columns, "rcm", Workload::bandwidth), "");
  EXPECT_EQ(reason_to_keep(graph, as_is, "rcm", Workload::bandwidth),
            "rcm is no better: the bandwidth is 40 in the old order and 40 in the new one");
  EXPECT_EQ(reason_to_keep(graph, as_is, "hilbert", Workload::all),
            "hilbert is no better: the mean edge span is 20.4 in the old order and 20.4 in the new one");
  // the factor of a path has only the path's entries
  EXPECT_EQ(reason_to_keep(test::path(50), Permutation::identity(50), "metis-nd", Workload::fill),
            "metis-nd is no better: the number of entries in the factor is 49 in the old order and 49 in the "
            "new one");
  if (!is_known("metis-nd")) return;
  const Permutation dissected = order_graph("metis-nd", {graph, {}}).permutation;
  EXPECT_EQ(reason_to_keep(graph, dissected, "metis-nd", Workload::fill), "");
  EXPECT_NE(reason_to_keep(graph, dissected, "metis-nd", Workload::all), "");
}

/// Places the vertices of 1,000 blocks of four: `first` of the first blocks, `second` of the next ones, and
/// "abcd" of the others.
Permutation blocks(std::string_view first, Index count, std::string_view second = "abcd", Index seconds = 0) {
  std::vector<Index> new_to_old;
  for (Index block = 0; block < 1000; ++block) {
    for (const char vertex : block < count ? first : block < count + seconds ? second : "abcd")
      new_to_old.push_back(4 * block + (vertex - 'a'));
  }
  return Permutation::from_new_to_old(std::move(new_to_old));
}

/// Returns whether `auto` would move blocks with the edges ab and cd.
bool moves(const Permutation& before, const Permutation& after) {
  std::vector<Edge> edges;
  for (Index v = 0; v < before.size(); v += 2) edges.push_back({v, v + 1});
  const CsrGraph graph = renumbered(graph_from_edges(before.size(), edges), before.old_to_new());
  return reason_to_keep(graph, before.inverse().then(after), "rcm", Workload::all).empty();
}

TEST(Judgement, MovesIfTheMeanSpanFallsByTwoPerCent) {
  // spans of 2 and 2 become 1 and 1
  EXPECT_FALSE(moves(blocks("acbd", 20), blocks("abcd", 0))) << "by 1.96 %";
  EXPECT_TRUE(moves(blocks("acbd", 21), blocks("abcd", 0))) << "by 2.06 %";
}

TEST(Judgement, ToleratesAMeanSpanThatGrowsByFivePerCentIfLogarithmsFall) {
  // in 800 blocks, spans of 2 and 2 become 3 and 1; in others, spans of 1 and 1 become 2 and 2
  EXPECT_TRUE(moves(blocks("acbd", 800), blocks("acdb", 800, "acbd", 80))) << "by 4.4 %";
  EXPECT_FALSE(moves(blocks("acbd", 800), blocks("acdb", 800, "acbd", 100))) << "by 5.6 %";
}

/// The edges of a path, in the given order.
Incidence edges_of_path(std::span<const Index> order) {
  Incidence edges{index_size(order) + 1, {0}, {}};
  for (const Index e : order) {
    edges.vertices.insert(edges.vertices.end(), {e, e + 1});
    edges.offsets.push_back(static_cast<Offset>(edges.vertices.size()));
  }
  return edges;
}

TEST(Auto, OrdersElementsByLexmax) {
  const Permutation places = test::shuffled(1000, 3);
  const Incidence elements = edges_of_path(places.new_to_old());
  const Permutation vertices = Permutation::identity(elements.vertex_count);
  const Order order = order_incidence("auto", {elements, vertices, {}, {}});
  EXPECT_EQ(order.method.name, "lexmax");
  EXPECT_FALSE(order.method.reason.empty());
  EXPECT_EQ(order.permutation, places.inverse());
}

TEST(Auto, KeepsElementsThatItWouldNotPlaceBetter) {
  // backwards along the path, which is as good
  std::vector<Index> backwards(1000);
  std::iota(backwards.rbegin(), backwards.rend(), 0);
  const Incidence elements = edges_of_path(backwards);
  const Permutation vertices = Permutation::identity(elements.vertex_count);
  const Order order = order_incidence("auto", {elements, vertices, {}, {}});
  EXPECT_TRUE(order.permutation.is_identity());
  EXPECT_EQ(order.method.name, "original");
  EXPECT_EQ(
      order.method.reason,
      "lexmax is no better: the mean number of vertices that 64 consecutive elements use is 63.5 in the old "
      "order and 63.5 in the new one");
  // a method that the user names is applied all the same
  EXPECT_FALSE(order_incidence("lexmax", {elements, vertices, {}, {}}).permutation.is_identity());
}

TEST(WorkingSets, CountTheVerticesOfConsecutiveElements) {
  // windows of 4096 edges: three, of which the last has 808, and 64 divides all but it; and 18, of which
  // every second is counted
  for (const auto& [edges, stride] : {std::pair{9000, 1}, std::pair{70000, 2}}) {
    const Permutation along = Permutation::identity(edges);
    const Permutation across = test::shuffled(edges, 4);
    const Incidence elements = edges_of_path(along.new_to_old());
    for (const Permutation* const permutation : {&along, &across}) {
      const std::span<const Index> order = permutation->new_to_old();
      const auto counted = working_sets(elements, order);
      for (std::size_t k = 0; k < kElementsAtOnce.size(); ++k) {
        std::size_t distinct = 0;
        std::size_t sets = 0;
        for (Index begin = 0; begin < edges; begin += kElementsAtOnce[k]) {
          if (begin / kElementsAtOnce.back() % stride != 0) continue;
          std::set<Index> used;
          for (Index place = begin; place < std::min(edges, begin + kElementsAtOnce[k]); ++place)
            used.insert({order[place], order[place] + 1});
          distinct += used.size();
          ++sets;
        }
        EXPECT_DOUBLE_EQ(counted[k], static_cast<double>(distinct) / static_cast<double>(sets));
      }
    }
  }
}

TEST(Auto, TakesNoGeometricMethodWhereCoordinatesTellNothing) {
  const Lattice lattice;
  const std::vector<Point> all_the_same(lattice.points.size(), Point{1, 2, 3});
  for (const Workload use : kWorkloads) {
    const std::string without = choose_vertex_method({lattice.graph, {}}, use).name;
    EXPECT_EQ(choose_vertex_method({lattice.graph, all_the_same}, use).name, without);
    EXPECT_NO_THROW(order_graph(without, {lattice.graph, {}}));
  }
}

TEST(Auto, LooksAtTheUse) {
  CsrGraph large;
  large.offsets.assign(2'000'001, 0);
  const auto taken = [&](Workload use) { return choose_vertex_method({large, {}}, use).name; };
  EXPECT_EQ(taken(Workload::all), taken(Workload::springs));
  EXPECT_NE(taken(Workload::springs), taken(Workload::element));
  EXPECT_EQ(taken(Workload::assembly), taken(Workload::element));
}

TEST(Auto, LooksAtTheSize) {
  CsrGraph large;
  large.offsets.assign(2'000'001, 0);
  const std::string small = choose_vertex_method({test::path(3), {}}, Workload::element).name;
  EXPECT_NE(choose_vertex_method({large, {}}, Workload::element).name, small);
}

TEST(Auto, KnowsLatticesByTheirNumbersOfNeighbours) {
  const Lattice rows(false);
  EXPECT_THAT(order_graph("auto", {rows.graph, rows.points}).method.reason,
              testing::HasSubstr("is no better: this is a lattice"));
  Lattice lattice;
  const auto taken = [&] {
    return choose_vertex_method({lattice.graph, lattice.points}, Workload::all).name;
  };
  EXPECT_EQ(taken(), "bfs");
  // the choice does not depend on the points
  for (Point& point : lattice.points) point = {std::sin(point[0]) + point[1], point[0] - point[1], 0};
  EXPECT_EQ(taken(), "bfs");
  lattice.graph = test::random_connected(lattice.graph.size(), 2 * lattice.graph.size(), 1);
  EXPECT_EQ(taken(), "hilbert-fronts");
}

TEST(Auto, JudgesLargeGraphsByTheirFirstTouches) {
  const CsrGraph graph = test::grid(50, 50, 50);
  std::vector<Point> points;
  for (Index v = 0; v < graph.size(); ++v)
    points.push_back({1.0 * (v % 50), 1.0 * (v / 50 % 50), 1.0 * (v / 2500)});
  const Permutation rows = Permutation::identity(graph.size());
  const Permutation hilbert = order_graph("hilbert", {graph, points}).permutation;
  const CsrGraph along = renumbered(graph, hilbert.old_to_new());
  for (const Workload use : {Workload::all, Workload::spmv, Workload::springs}) {
    EXPECT_THAT(
        reason_to_keep(graph, hilbert, "hilbert", use),
        testing::HasSubstr("lines that a sweep first reads out of order is 0.00 in the old order and 0."));
    EXPECT_EQ(reason_to_keep(along, hilbert.inverse(), "rows", use), "");
  }
}

TEST(Auto, MethodsAskedForByNameGiveNoReason) {
  const Lattice lattice;
  const Order order = order_graph("bfs", {lattice.graph, lattice.points});
  EXPECT_EQ(order.method, (MethodChoice{"bfs", ""}));
}

TEST(Workload, HasANameThatFindsIt) {
  for (const Workload use : kWorkloads) EXPECT_EQ(parse_workload(to_string(use)), use);
  try {
    parse_workload("everything");
    FAIL();
  } catch (const InvalidArgument& error) {
    for (const Workload use : kWorkloads) {
      EXPECT_NE(std::string(error.what()).find(to_string(use)), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace meshorder
