// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/edge_span.hpp"
#include "ordering/judgement.hpp"
#include "ordering/method.hpp"
#include "ordering/moved.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

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

TEST(Auto, KeepsAnOrderThatItWouldNotMakeBetter) {
  const Lattice in_rows(false);
  for (const Workload use : kWorkloads) {
    if (use == Workload::fill) continue;
    SCOPED_TRACE(to_string(use));
    const Order order = order_graph("auto", {in_rows.graph, in_rows.points}, options_for(use));
    EXPECT_EQ(order.method.name, "original");
    EXPECT_TRUE(order.permutation.is_identity());
    EXPECT_THAT(order.method.reason, testing::HasSubstr("is no better: the "));
  }
  // asked for by name it is made all the same
  EXPECT_FALSE(order_graph("hilbert", {in_rows.graph, in_rows.points}).permutation.is_identity());
}

TEST(Auto, JudgesByTheUse) {
  const CsrGraph graph = test::grid(40, 30);
  const Permutation as_is = Permutation::identity(graph.size());
  // in rows of 40 the bandwidth is 40, in columns of 30 it would be 30
  const Permutation columns = order_graph("rcm", {graph, {}}).permutation;
  EXPECT_EQ(reason_to_keep(graph, columns, "rcm", Workload::bandwidth), "");
  EXPECT_EQ(reason_to_keep(graph, as_is, "rcm", Workload::bandwidth),
            "rcm is no better: the bandwidth is 40 as it is and 40 by rcm");
  EXPECT_EQ(reason_to_keep(graph, as_is, "hilbert", Workload::all),
            "hilbert is no better: the mean edge span is 20.4 as it is and 20.4 by hilbert");
  // the factor of a path has no entry but the path's
  EXPECT_EQ(reason_to_keep(test::path(50), Permutation::identity(50), "metis-nd", Workload::fill),
            "metis-nd is no better: the number of entries in the factor is 49 as it is and 49 by metis-nd");
  if (!is_known("metis-nd")) return;
  const Permutation dissected = order_graph("metis-nd", {graph, {}}).permutation;
  EXPECT_EQ(reason_to_keep(graph, dissected, "metis-nd", Workload::fill), "");
  EXPECT_NE(reason_to_keep(graph, dissected, "metis-nd", Workload::all), "");
}

TEST(Auto, OrdersElementsByLexmax) {
  const Incidence elements{4, {0, 2, 4, 6}, {0, 3, 0, 1, 1, 2}};
  const Permutation vertices = Permutation::identity(4);
  const ElementInput problem{elements, vertices, {}, {}};
  const Order order = order_incidence("auto", problem);
  EXPECT_EQ(order.method.name, "lexmax");
  EXPECT_FALSE(order.method.reason.empty());
  EXPECT_THAT(order.permutation.new_to_old(), testing::ElementsAre(1, 2, 0));
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
  EXPECT_EQ(taken(Workload::all), taken(Workload::element));
  EXPECT_NE(taken(Workload::springs), taken(Workload::element));
}

TEST(Auto, LooksAtTheSize) {
  CsrGraph large;
  large.offsets.assign(2'000'001, 0);
  const std::string small = choose_vertex_method({test::path(3), {}}, Workload::springs).name;
  EXPECT_NE(choose_vertex_method({large, {}}, Workload::springs).name, small);
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
