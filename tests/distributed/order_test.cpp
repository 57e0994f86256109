// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/order.hpp"

#include "mesh/procedural.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "slices.hpp"
#include "support/sample_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace meshorder::distributed {
namespace {

using test::ordered;
using test::WholeOrder;

class Methods : public testing::TestWithParam<Partitioner> {};

TEST_P(Methods, HaveSpansLikeTheSerialOrder) {
  const Communicator communicator;
  for (const Mesh& mesh : {make_ball({.size = 24}), make_torus({.size = 12})}) {
    std::vector<WholeOrder> orders;
    for (const Index parts : {2, 8})
      orders.push_back(ordered(communicator, mesh, {.partitioner = GetParam(), .parts = parts}));
    if (!communicator.is_root()) continue;  // the root alone checks the result
    const CsrGraph graph = vertex_graph(mesh);
    const EdgeSpan serial = edge_span(graph, order_graph("spectral", {.graph = graph}).permutation);
    // parts that are ranges of a curve have rougher boundaries
    const bool is_scotch = GetParam() == Partitioner::ptscotch;
    for (const WholeOrder& order : orders) {
      const EdgeSpan span = edge_span(graph, order.vertices);
      EXPECT_LE(span.mean_log2, (is_scotch ? 1.02 : 1.10) * serial.mean_log2) << order.report.parts;
      EXPECT_LE(span.mean, (is_scotch ? 1.2 : 2.0) * serial.mean) << order.report.parts;
      EXPECT_NEAR(order.report.after.mean, span.mean, 1e-9 * span.mean);
      EXPECT_NEAR(order.report.after.mean_log2, span.mean_log2, 1e-9);
      EXPECT_EQ(order.report.after.max, span.max);
      EXPECT_EQ(order.report.edges, graph.edge_count());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Partitioners, Methods, testing::Values(Partitioner::ptscotch, Partitioner::hilbert),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST(DistributedOrder, OrdersCellsAsTheSerialLexmaxDoes) {
  const Communicator communicator;
  for (const Mesh& mesh : {make_ball({.size = 6}), test::mixed_mesh(), test::triangles_and_line(4)}) {
    const WholeOrder order = ordered(communicator, mesh, {.parts = 3});
    const Order serial = order_cells("lexmax", cell_arrays(mesh), order.vertices, mesh.points, {}, {});
    EXPECT_EQ(order.cells, serial.permutation);
  }
}

TEST(DistributedOrder, KeepsPartsTogether) {
  const Communicator communicator;
  const Mesh mesh = make_grid({.size = 9});
  const WholeOrder order = ordered(communicator, mesh, {.partitioner = Partitioner::hilbert, .parts = 4});
  const WholeOrder in_bfs =
      ordered(communicator, mesh, {.vertices = "bfs", .partitioner = Partitioner::hilbert, .parts = 4});
  // 1,000 vertices in four parts: the method does not change the part of a vertex
  for (Index v = 0; v < 1000; ++v)
    EXPECT_EQ(order.vertices.old_to_new()[v] / 250, in_bfs.vertices.old_to_new()[v] / 250) << v;
  EXPECT_NE(order.vertices, in_bfs.vertices);
}

TEST(DistributedOrder, PutsInterfacesLastInTheirOrder) {
  const Communicator communicator;
  const Mesh mesh = make_ball({.size = 10});
  const CsrGraph graph = vertex_graph(mesh);
  for (const Partitioner by : {Partitioner::ptscotch, Partitioner::hilbert}) {
    const WholeOrder mixed = ordered(communicator, mesh, {.partitioner = by, .parts = 4});
    const WholeOrder last =
        ordered(communicator, mesh, {.partitioner = by, .parts = 4, .interface_place = InterfacePlace::last});
    ASSERT_EQ(last.report.part_starts, mixed.report.part_starts);
    ASSERT_EQ(last.report.interfaces, mixed.report.interfaces);
    const std::vector<GlobalIndex>& starts = last.report.part_starts;
    for (std::size_t p = 0; p < 4; ++p) {
      // the vertices of the part in the mixed order: the interior and the rim
      std::vector<Index> interior;
      std::vector<Index> rim;
      for (GlobalIndex place = starts[p]; place < starts[p + 1]; ++place) {
        const Index vertex = mixed.vertices.new_to_old()[static_cast<std::size_t>(place)];
        const auto neighbours = graph[vertex];
        const bool touches = std::any_of(neighbours.begin(), neighbours.end(), [&](Index other) {
          const GlobalIndex at = mixed.vertices.old_to_new()[other];
          return at < starts[p] || at >= starts[p + 1];
        });
        (touches ? rim : interior).push_back(vertex);
      }
      EXPECT_EQ(std::ssize(rim), last.report.interfaces[p]);
      EXPECT_FALSE(rim.empty());
      interior.insert(interior.end(), rim.begin(), rim.end());
      const auto moved =
          last.vertices.new_to_old().subspan(static_cast<std::size_t>(starts[p]), interior.size());
      EXPECT_TRUE(std::equal(interior.begin(), interior.end(), moved.begin())) << p;
    }
  }
}

TEST(DistributedOrder, TurnsMethodsTowardsTheNeighbours) {
  const Communicator communicator;
  const Mesh mesh = make_grid({.size = 12});
  const CsrGraph graph = vertex_graph(mesh);
  // parts of a curve, each ordered along it: in a reversed part, edges to other parts would be long
  const WholeOrder order =
      ordered(communicator, mesh, {.vertices = "fiedler", .partitioner = Partitioner::hilbert, .parts = 8});
  const EdgeSpan scattered_spans = edge_span(graph, order_graph("original", {.graph = graph}).permutation);
  EXPECT_LT(edge_span(graph, order.vertices).mean, 3 * scattered_spans.mean);
}

TEST(DistributedOrder, PutsVerticesWithoutElementsLastInTheirOrder) {
  const Communicator communicator;
  Mesh mesh = make_grid({.size = 5});  // 216 vertices
  for (int k = 0; k < 7; ++k) mesh.points.push_back({static_cast<double>(-k), 0.5, 0.25});
  const WholeOrder order = ordered(communicator, mesh, {.parts = 2});
  for (Index v = 216; v < 223; ++v) EXPECT_EQ(order.vertices.old_to_new()[v], v);
}

TEST(DistributedOrder, TakesMeshesOfAnySort) {
  const Communicator communicator;
  Mesh fan;  // a hub that every element uses
  fan.points.push_back({0, 0, 0});
  const Index rim = 20'000;
  for (Index v = 1; v <= rim; ++v) {
    fan.points.push_back({1.0 * v, 1, 0});
    if (v > 1) fan.cells.push_back(Shape::triangle, std::vector<Index>{0, v - 1, v});
  }
  Mesh points;  // no cells at all
  points.points = {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}};
  Mesh in_one_place = make_grid({.size = 2});
  for (Point& point : in_one_place.points) point = {1, 2, 3};
  for (const Mesh& mesh : {fan, points, in_one_place, Mesh(), test::cells_of_type(Shape::triangle, 3, 500),
                           test::cells_of_type(Shape::vertex, 1, 3), test::triangles_and_line(1)}) {
    for (const Index parts : {1, 4, 30}) {
      const WholeOrder order = ordered(communicator, mesh, {.parts = parts});
      EXPECT_EQ(order.vertices.size(), mesh.vertex_count());
      EXPECT_EQ(order.cells.size(), mesh.cell_count());
    }
  }
}

TEST(DistributedOrder, RefusesMethodsWithoutMeaningInParts) {
  const Communicator communicator;
  for (const char* const method : {"original", "auto", "spectrall"}) {
    try {
      (void)ordered(communicator, make_grid({.size = 2}), {.vertices = method});
      FAIL() << method;
    } catch (const SharedError& error) {
      EXPECT_EQ(error.code(), Code::invalid_argument);
      EXPECT_THAT(error.what(), testing::HasSubstr("known: fiedler, minla, spectral"));
    }
  }
}

}  // namespace
}  // namespace meshorder::distributed
