// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/grouped.hpp"

#include "ordering/method.hpp"
#include "support/sample_graphs.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <string>

namespace meshorder {
namespace {

std::vector<Point> lattice_points(Index columns, Index n) {
  std::vector<Point> points;
  points.reserve(n);
  for (Index v = 0; v < n; ++v) points.push_back({1.0 * (v % columns), 0.1 * v, 0.0});
  return points;
}

TEST(OrderInGroups, IsTheMethodsOrderOfEachGroupsOwnGraph) {
  const CsrGraph graph = test::grid(20, 15);
  const std::vector<Point> points = lattice_points(20, graph.size());
  std::vector<Index> group_of(graph.size());
  for (Index v = 0; v < graph.size(); ++v)
    group_of[v] = (v % 20) / 7 == 1 ? 0 : v < 150 ? 3 : 1;  // group 2 is empty
  for (const MethodInfo& method : vertex_methods()) {
    if (method.name == "auto") continue;
    SCOPED_TRACE(method.name);
    const Order order = order_graph_in_groups(method.name, {graph, points}, group_of, 4);
    EXPECT_EQ(order.method, (MethodChoice{std::string(method.name), ""}));
    std::vector<Index> expected;
    std::vector<double> vector;
    std::size_t components = 0;
    for (Index group = 0; group < 4; ++group) {
      std::vector<Index> members;
      std::vector<Point> of_members;
      for (Index v = 0; v < graph.size(); ++v) {
        if (group_of[v] != group) continue;
        members.push_back(v);
        of_members.push_back(points[v]);
      }
      const CsrGraph subgraph = induced_subgraph(graph, members);
      const Order alone = order_graph(method.name, {subgraph, of_members});
      for (const Index k : alone.permutation.new_to_old()) expected.push_back(members[k]);
      components += alone.fiedler.size();
      if (alone.vector.empty()) continue;
      vector.resize(group_of.size());
      for (std::size_t k = 0; k < members.size(); ++k) vector[members[k]] = alone.vector[k];
    }
    EXPECT_THAT(order.permutation.new_to_old(), testing::ElementsAreArray(expected));
    EXPECT_EQ(order.fiedler.size(), components);
    EXPECT_EQ(order.vector, vector);
  }
}

TEST(OrderInGroups, ChoosesOneMethodForAllGroups) {
  const CsrGraph graph = test::grid(20, 15);
  std::vector<Index> group_of(graph.size(), 0);
  for (Index v = 0; v < 100; ++v) group_of[v] = 1;
  const Order order = order_graph_in_groups("auto", {graph, {}}, group_of, 2);
  EXPECT_EQ(order.method, choose_vertex_method({graph, {}}, Workload::all));
  EXPECT_EQ(order.permutation,
            order_graph_in_groups(order.method.name, {graph, {}}, group_of, 2).permutation);
}

TEST(OrderInGroups, ComesToAnEndOnManyGroups) {
  const Index n = test::large(400000);
  const CsrGraph graph = test::path(n);
  std::vector<Index> group_of(static_cast<std::size_t>(n));
  std::iota(group_of.rbegin(), group_of.rend(), Index{0});
  const Order order = order_graph_in_groups("rcm", {graph, {}}, group_of, n);
  EXPECT_EQ(order.permutation.new_to_old().front(), n - 1);
}

TEST(OrderInGroups, RefusesGroupsThatDoNotFit) {
  const CsrGraph graph = test::path(3);
  const std::vector<Index> too_few{0, 0};
  const std::vector<Index> too_large{0, 2, 1};
  const std::vector<Index> negative{0, -1, 1};
  for (const auto& group_of : {too_few, too_large, negative}) {
    EXPECT_THROW(order_graph_in_groups("bfs", {graph, {}}, group_of, 2), InvalidArgument);
  }
  EXPECT_THROW(order_graph_in_groups("best", {graph, {}}, std::vector<Index>{0, 0, 0}, 1), InvalidArgument);
  EXPECT_EQ(order_graph_in_groups("bfs", {CsrGraph{}, {}}, {}, 0).permutation.size(), 0);
}

}  // namespace
}  // namespace meshorder
