// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/method.hpp"

#include "mesh/graphs.hpp"
#include "support/refusal.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <string>

namespace meshorder {
namespace {
using test::refusal;

std::vector<Point> random_points(Index n) {
  std::mt19937_64 random(9);
  std::vector<Point> points(n);
  for (Point& point : points) {
    for (double& x : point) x = static_cast<double>(random() % 1000U) / 7;
  }
  return points;
}

void expect_bijection(const Permutation& order, Index n) {
  ASSERT_EQ(order.size(), n);
  std::vector<Index> sorted(order.new_to_old().begin(), order.new_to_old().end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> all(n);
  std::iota(all.begin(), all.end(), Index{0});
  EXPECT_EQ(sorted, all);
  for (Index v = 0; v < n; ++v) EXPECT_EQ(order.new_to_old()[order.old_to_new()[v]], v);
}

std::vector<test::NamedGraph> vertex_graphs() {
  return {{"nothing", CsrGraph{}},
          {"one vertex", test::path(1)},
          {"one edge", test::path(2)},
          {"isolated vertices", graph_from_edges(40, {})},
          {"one edge among isolated vertices", graph_from_edges(300, std::vector<Edge>{{40, 200}})},
          {"components", test::disjoint_union({test::path(1), test::grid(7, 6), test::path(2), test::path(1),
                                               test::grid(7, 6), test::star(30), test::cycle(5)})},
          {"many components", test::disjoint_union(std::vector<CsrGraph>(200, test::complete(4)))},
          {"grid", test::grid(30, 20)},
          {"star", test::star(500)},
          {"complete graph", test::complete(150)},
          {"power law", test::preferential_attachment(600, 2, 1)},
          {"mixed mesh", vertex_graph(test::mixed_mesh())},
          {"bar", vertex_graph(test::tetrahedral_bar(12))}};
}

TEST(VertexMethods, YieldABijectionAndKeepQuiet) {
  for (const MethodInfo& method : vertex_methods()) {
    for (const auto& [name, graph] : vertex_graphs()) {
      SCOPED_TRACE(std::string(method.name) + " on " + name);
      const std::vector<Point> points = random_points(graph.size());
      testing::internal::CaptureStdout();
      const Order order = order_graph(method.name, {graph, points});
      EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
      expect_bijection(order.permutation, graph.size());
      EXPECT_EQ(order_graph(method.name, {graph, points}).permutation, order.permutation) << "run again";
      const bool spectral = method.name.starts_with("fiedler") || method.name.starts_with("minla");
      EXPECT_EQ(!order.fiedler.empty(), spectral && graph.size() > 0);
    }
  }
}

TEST(VertexMethods, PutIsolatedVerticesLastInOldOrderButForOriginal) {
  const CsrGraph graph =
      test::disjoint_union({test::path(1), test::grid(5, 4), test::path(1), test::path(3), test::path(1)});
  const std::vector<Point> points = random_points(graph.size());
  for (const MethodInfo& method : vertex_methods()) {
    const Order order = order_graph(method.name, {graph, points});
    if (order.method.name == "original") {  // `auto` keeps this order, too
      EXPECT_TRUE(order.permutation.is_identity()) << method.name;
      continue;
    }
    const std::span<const Index> new_to_old = order.permutation.new_to_old();
    const std::vector<Index> last(new_to_old.end() - 3, new_to_old.end());
    EXPECT_EQ(last, (std::vector<Index>{0, 21, 25})) << method.name;
  }
}

TEST(VertexMethods, ComeToAnEndOnManyIsolatedVertices) {
  const CsrGraph graph =
      test::disjoint_union({graph_from_edges(test::large(400000), {}),
                            test::disjoint_union(std::vector<CsrGraph>(2000, test::path(3)))});
  const std::vector<Point> points = random_points(graph.size());
  for (const MethodInfo& method : vertex_methods()) {
    if (method.name.starts_with("metis")) continue;  // slow on such graphs
    EXPECT_EQ(order_graph(method.name, {graph, points}).permutation.size(), graph.size());
  }
}

TEST(VertexMethods, OfGeometryNeedCoordinatesAndOthersDoNot) {
  const CsrGraph graph = test::grid(5, 4);
  const std::vector<Point> too_few = random_points(19);
  for (const MethodInfo& method : vertex_methods()) {
    if (method.needs_points) {
      EXPECT_THROW(order_graph(method.name, {graph, {}}), InvalidArgument) << method.name;
      EXPECT_THROW(order_graph(method.name, {graph, too_few}), InvalidArgument) << method.name;
    } else {
      EXPECT_NO_THROW(order_graph(method.name, {graph, {}})) << method.name;
    }
  }
}

TEST(Methods, OfUnknownNamesAreRefusedWithTheNearestOrAllKnownOnes) {
  const CsrGraph graph = test::path(3);
  EXPECT_EQ(refusal([&] {
              order_graph("fielder", {graph, {}});
            }),
            "unknown vertex order 'fielder'; did you mean 'fiedler'?");
  const std::string of_vertices = refusal([&] { order_graph("best", {graph, {}}); });
  EXPECT_NE(of_vertices.find("'best'"), std::string::npos) << of_vertices;
  for (const MethodInfo& method : vertex_methods()) {
    EXPECT_NE(of_vertices.find(method.name), std::string::npos) << of_vertices;
  }
  const Permutation vertices = Permutation::identity(0);
  const std::string of_elements = refusal([&] { order_incidence("", {Incidence{}, vertices, {}, {}}); });
  for (const MethodInfo& method : element_methods()) {
    EXPECT_NE(of_elements.find(method.name), std::string::npos) << of_elements;
  }
}

TEST(Methods, HaveDistinctNamesAndASentenceEach) {
  std::set<std::string_view> names;
  for (const MethodInfo& method : vertex_methods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_FALSE(method.description.empty());
  }
  names.clear();
  for (const MethodInfo& method : element_methods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_FALSE(method.description.empty());
  }
}

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

std::vector<NamedMesh> meshes() {
  Mesh points_only;
  points_only.points = random_points(5);
  Mesh one;
  one.points = random_points(3);
  one.cells.push_back(Shape::triangle, std::vector<Index>{0, 1, 2});
  Mesh twice = one;
  twice.cells.push_back(Shape::triangle, std::vector<Index>{2, 1, 0});
  Mesh degenerate = one;
  degenerate.cells.push_back(Shape::triangle, std::vector<Index>{1, 1, 1});
  return {{"nothing", Mesh{}},
          {"points only", points_only},
          {"one triangle", one},
          {"a triangle twice", twice},
          {"a degenerate triangle", degenerate},
          {"disjoint hexahedra", test::cells_of_type(Shape::hexahedron, 8, 20)},
          {"mixed mesh", test::mixed_mesh()},
          {"bar", test::tetrahedral_bar(12)}};
}

TEST(ElementMethods, YieldABijection) {
  for (const MethodInfo& method : element_methods()) {
    for (const auto& [name, mesh] : meshes()) {
      SCOPED_TRACE(std::string(method.name) + " on " + name);
      const CellArrays cells = cell_arrays(mesh);
      const CellSelection top = CellSelection::elements(cells);
      const Permutation vertices = test::shuffled(mesh.vertex_count(), 3);
      const ElementInput problem{top.incidence(), vertices, mesh.points,
                                 [&m = mesh] { return facet_graph(m); }};
      const Order order = order_incidence(method.name, problem);
      expect_bijection(order.permutation, top.size());
      EXPECT_EQ(order_incidence(method.name, problem).permutation, order.permutation) << "run again";
      EXPECT_EQ(!order.fiedler.empty(), method.name.starts_with("fiedler") && top.size() > 0);
    }
  }
}

TEST(ElementMethods, OfGeometryNeedCoordinatesAndOthersDoNot) {
  const Mesh mesh = test::tetrahedral_bar(3);
  const CellArrays cells = cell_arrays(mesh);
  const CellSelection top = CellSelection::elements(cells);
  const Permutation vertices = Permutation::identity(mesh.vertex_count());
  const ElementInput problem{top.incidence(), vertices, {}, [&] { return facet_graph(mesh); }};
  for (const MethodInfo& method : element_methods()) {
    if (method.name == "hilbert") {
      const std::string message = refusal([&] { order_incidence(method.name, problem); });
      EXPECT_NE(message.find("'hilbert'"), std::string::npos) << message;
      EXPECT_NE(message.find(std::to_string(mesh.vertex_count()) + " vertices"), std::string::npos)
          << message;
    } else {
      EXPECT_NO_THROW(order_incidence(method.name, problem)) << method.name;
    }
  }
}

}  // namespace
}  // namespace meshorder
