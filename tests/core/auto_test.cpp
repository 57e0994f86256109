// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/method.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace meshorder {
namespace {

/// A grid graph on the points of its lattice.
struct Lattice {
  CsrGraph graph = test::grid(12, 9);
  std::vector<Point> points;

  Lattice() {
    for (Index v = 0; v < graph.size(); ++v) points.push_back({1.0 * (v % 12), 0.1 * v, 0.0});
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
