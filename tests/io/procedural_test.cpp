// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/procedural.hpp"

#include "graph/traversal.hpp"
#include "mesh/graphs.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace meshorder {
namespace {

constexpr double kMostJitter = 0.15;

double volume(const Mesh& mesh, Index cell) {
  const auto vertices = mesh.cells[cell];
  std::array<Point, 3> edge{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a)
      edge[k][a] = mesh.points[vertices[k + 1]][a] - mesh.points[vertices[0]][a];
  }
  return (edge[0][0] * (edge[1][1] * edge[2][2] - edge[1][2] * edge[2][1]) -
          edge[0][1] * (edge[1][0] * edge[2][2] - edge[1][2] * edge[2][0]) +
          edge[0][2] * (edge[1][0] * edge[2][1] - edge[1][1] * edge[2][0])) /
         6;
}

/// EXPECTs positive volumes and returns their sum.
double total_volume(const Mesh& mesh) {
  double sum = 0;
  double least = 1;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    sum += volume(mesh, c);
    least = std::min(least, volume(mesh, c));
  }
  EXPECT_GT(least, 0);
  return sum;
}

/// Faces by their corners, and how many tetrahedra have each.
std::map<std::set<Index>, int> faces_of(const Mesh& mesh) {
  std::map<std::set<Index>, int> faces;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::set<Index> face(mesh.cells[c].begin(), mesh.cells[c].end());
      face.erase(mesh.cells[c][left_out]);
      ++faces[face];
    }
  }
  return faces;
}

/// Vertices − edges + faces − tetrahedra.
Index euler_characteristic(const Mesh& mesh) {
  return mesh.vertex_count() - static_cast<Index>(vertex_graph(mesh).edge_count()) +
         index_size(faces_of(mesh)) - mesh.cell_count();
}

/// The triangles that belong to only one tetrahedron; EXPECTs that none belongs to more than two.
std::vector<std::vector<Index>> boundary_of(const Mesh& mesh) {
  std::vector<std::vector<Index>> result;
  for (const auto& [face, count] : faces_of(mesh)) {
    EXPECT_LE(count, 2);
    if (count == 1) result.emplace_back(face.begin(), face.end());
  }
  return result;
}

/// Vertices − edges + triangles of a surface; EXPECTs every edge to have two triangles.
Index euler_characteristic(const std::vector<std::vector<Index>>& surface) {
  std::set<Index> vertices;
  std::map<std::pair<Index, Index>, int> edges;
  for (const auto& triangle : surface) {
    vertices.insert(triangle.begin(), triangle.end());
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 2)})
      ++edges[{triangle[a], triangle[b]}];
  }
  for (const auto& [edge, count] : edges) EXPECT_EQ(count, 2);
  return index_size(vertices) - index_size(edges) + index_size(surface);
}

TEST(ProceduralModels, HaveTheCountsThatTheyPromise) {
  for (const Index n : {1, 2, 5}) {
    for (const Mesh& mesh : {make_grid({n, 0.1, 0}), make_ball({n, 0.1, 0})}) {
      check_mesh(mesh);
      EXPECT_EQ(mesh.vertex_count(), (n + 1) * (n + 1) * (n + 1));
      EXPECT_EQ(mesh.cell_count(), 6 * n * n * n);
    }
    const Mesh torus = make_torus({n, 0.1, 0});
    check_mesh(torus);
    EXPECT_EQ(torus.vertex_count(), 8 * n * (n + 1) * (n + 1));
    EXPECT_EQ(torus.cell_count(), 6 * 8 * n * n * n);
  }
}

TEST(ProceduralModels, HavePositiveVolumesAtTheMostJitter) {
  for (const Index n : {1, 2, 3, 4, 7, 12}) {
    for (const std::uint64_t seed : {0U, 1U, 2U, 3U, 4U}) {
      if (test::kSanitized && n > 4 && seed > 0) continue;
      SCOPED_TRACE(std::to_string(n) + " cubes, seed " + std::to_string(seed));
      EXPECT_NEAR(total_volume(make_grid({n, kMostJitter, seed})), 1, 1e-12) << "the cube is filled";
      total_volume(make_ball({n, kMostJitter, seed}));
      total_volume(make_torus({n, kMostJitter, seed}));
    }
  }
}

TEST(ProceduralModels, FillTheShapesThatTheyStandFor) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(total_volume(make_ball({24, kMostJitter, 0})), 4 * kPi / 3, 0.04);
  EXPECT_NEAR(total_volume(make_torus({16, kMostJitter, 0})), 2 * kPi * kPi * 0.4 * 0.4, 0.04);
}

TEST(ProceduralModels, StayWithinTheirShapes) {
  for (const Point& p : make_ball({9, kMostJitter, 1}).points) {
    EXPECT_LE(std::hypot(p[0], p[1], p[2]), 1 + 1e-12);
  }
  for (const Point& p : make_torus({6, kMostJitter, 1}).points) {
    EXPECT_LE(std::hypot(std::hypot(p[0], p[1]) - 1, p[2]), 0.4 + 1e-12);
  }
  for (const Point& p : make_grid({7, kMostJitter, 1}).points) {
    for (const double x : p) EXPECT_TRUE(x >= 0 && x <= 1);
  }
}

TEST(ProceduralModels, TheBallsBoundaryLiesOnTheSphere) {
  const Mesh ball = make_ball({6, kMostJitter, 2});
  for (const auto& triangle : boundary_of(ball)) {
    for (const Index v : triangle) {
      EXPECT_NEAR(std::hypot(ball.points[v][0], ball.points[v][1], ball.points[v][2]), 1, 1e-12);
    }
  }
}

TEST(ProceduralModels, HaveTheTopologyOfTheirShapes) {
  for (const Index n : {1, 3}) {
    const Mesh ball = make_ball({n, 0.1, 0});
    EXPECT_EQ(euler_characteristic(ball), 1);
    EXPECT_EQ(euler_characteristic(boundary_of(ball)), 2);
    const Mesh torus = make_torus({n, 0.1, 0});
    EXPECT_EQ(euler_characteristic(torus), 0);
    EXPECT_EQ(euler_characteristic(boundary_of(torus)), 0);
    EXPECT_EQ(connected_components(vertex_graph(torus)).size(), 1U);
    EXPECT_EQ(connected_components(facet_graph(torus)).size(), 1U);
  }
}

TEST(ProceduralModels, AreTheSameForTheSameSeedOnly) {
  for (const auto make : {make_grid, make_ball, make_torus}) {
    test::expect_same(make({4, kMostJitter, 7}), make({4, kMostJitter, 7}));
    EXPECT_NE(make({4, kMostJitter, 7}).points, make({4, kMostJitter, 8}).points);
    EXPECT_EQ(make({4, 0, 7}).points, make({4, 0, 8}).points) << "nothing to seed without jitter";
  }
}

TEST(ProceduralModels, MoveInnerVerticesByNoMoreThanTheJitter) {
  const Mesh regular = make_grid({6, 0, 0});
  const Mesh jittered = make_grid({6, 0.1, 0});
  double most = 0;
  for (Index v = 0; v < regular.vertex_count(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double moved = std::abs(jittered.points[v][a] - regular.points[v][a]) * 6;
      most = std::max(most, moved);
      const bool at_rim = regular.points[v][a] == 0 || regular.points[v][a] == 1;
      EXPECT_TRUE(!at_rim || moved == 0);
    }
  }
  EXPECT_LE(most, 0.1 + 1e-12);
  EXPECT_GT(most, 0.09);
}

TEST(ProceduralModels, RefuseWhatCannotBeMade) {
  for (const auto make : {make_grid, make_ball, make_torus}) {
    EXPECT_THROW(make({0, 0.1, 0}), InvalidArgument);
    EXPECT_THROW(make({-3, 0.1, 0}), InvalidArgument);
    EXPECT_THROW(make({2, -0.01, 0}), InvalidArgument);
    EXPECT_THROW(make({2, 0.16, 0}), InvalidArgument);
    EXPECT_THROW(make({2, std::nan(""), 0}), InvalidArgument);
    EXPECT_THROW(make({100000, 0.1, 0}), InvalidArgument);
    EXPECT_THROW(make({kMaxIndex, 0.1, 0}), InvalidArgument);
  }
}

}  // namespace
}  // namespace meshorder
