// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/embedded_vertices.hpp"

#include "base/point.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

/// Two second-order tetrahedra with straight edges that share a face.
Mesh straight_quadratic() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0}, {0.1, 0.2, 1}, {1, 1, 1.3}};
  constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  for (const std::array<Index, 4>& corners : {std::array<Index, 4>{0, 1, 2, 3}, {1, 2, 3, 4}}) {
    std::vector<Index> cell(corners.begin(), corners.end());
    for (const auto& [a, b] : kEdges) {
      Point middle{};
      for (std::size_t c = 0; c < 3; ++c)
        middle[c] = 0.5 * (mesh.points[corners[a]][c] + mesh.points[corners[b]][c]);
      const auto known = std::find(mesh.points.begin(), mesh.points.end(), middle);
      cell.push_back(static_cast<Index>(known - mesh.points.begin()));
      if (known == mesh.points.end()) mesh.points.push_back(middle);
    }
    mesh.cells.push_back(Shape::tetrahedron, cell);
  }
  mesh.points.push_back({9, 9, 9});  // a point of no cell
  return mesh;
}

TEST(EmbeddedVertices, NodesOfStraightEdgesAreTheMeanOfTheEnds) {
  const Mesh mesh = straight_quadratic();
  const std::vector<EmbeddedVertex> found = embed_vertices(mesh, cut_into_simplices(mesh));
  ASSERT_EQ(found.size(), 9U);  // 9 edges
  for (const EmbeddedVertex& entry : found) {
    EXPECT_GE(entry.vertex, 5);
    EXPECT_LT(entry.vertex, 14);
    std::array<double, 4> sorted = entry.weights;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_NEAR(sorted[0], 0.0, 1e-15);
    EXPECT_NEAR(sorted[1], 0.0, 1e-15);
    EXPECT_NEAR(sorted[2], 0.5, 1e-15);
    EXPECT_NEAR(sorted[3], 0.5, 1e-15);
    for (std::size_t c = 0; c < 3; ++c) {
      double mean = 0.0;
      for (std::size_t i = 0; i < 4; ++i) mean += entry.weights[i] * mesh.points[entry.corners[i]][c];
      EXPECT_NEAR(mean, mesh.points[entry.vertex][c], 1e-15);
    }
  }
}

TEST(EmbeddedVertices, AreAllOtherNodesOfVolumeCellsAndGoAlongAffineMotions) {
  const Mesh mesh = test::mixed_mesh();
  const Simplices simplices = cut_into_simplices(mesh);
  std::vector<char> expected(mesh.points.size(), 0);
  for (Index cell = 0; cell < mesh.cell_count(); ++cell) {
    if (dimension(mesh.cells.shapes[cell]) < 3) continue;
    for (const Index v : mesh.cells[cell]) expected[v] = 1;
  }
  for (const Index v : simplices.vertices) expected[v] = 0;
  const std::vector<EmbeddedVertex> found = embed_vertices(mesh, simplices);
  EXPECT_EQ(static_cast<long>(found.size()), std::count(expected.begin(), expected.end(), 1));
  EXPECT_GT(found.size(), 10U);
  for (const EmbeddedVertex& entry : found) {
    EXPECT_EQ(expected[entry.vertex], 1);
    EXPECT_NEAR(std::accumulate(entry.weights.begin(), entry.weights.end(), 0.0), 1.0, 1e-12);
    for (std::size_t c = 0; c < 3; ++c) {
      double mean = 0.0;
      for (std::size_t i = 0; i < 4; ++i) mean += entry.weights[i] * mesh.points[entry.corners[i]][c];
      EXPECT_NEAR(mean, mesh.points[entry.vertex][c], 1e-9);
    }
  }
}

TEST(EmbeddedVertices, MoveAsTheirCornersDoWhereverTheyWere) {
  const Mesh mesh = straight_quadratic();
  const std::vector<EmbeddedVertex> found = embed_vertices(mesh, cut_into_simplices(mesh));
  const Point shift{1, 2, 3};
  const Point velocity{4, -5, 6};
  MotionState state;
  state.positions.assign(mesh.points.size(), Point{7, 7, 7});
  state.velocities.assign(mesh.points.size(), Point{8, 8, 8});
  for (std::size_t corner = 0; corner < 5; ++corner) {
    state.positions[corner] = plus_scaled(mesh.points[corner], 1.0, shift);
    state.velocities[corner] = velocity;
  }
  move_embedded(found, mesh.points, state);
  for (const EmbeddedVertex& entry : found) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(state.positions[entry.vertex][c], mesh.points[entry.vertex][c] + shift[c], 1e-14);
      EXPECT_NEAR(state.velocities[entry.vertex][c], velocity[c], 1e-14);
    }
  }
}

TEST(EmbeddedVertices, LinearMeshesHaveNone) {
  const Mesh mesh = test::tetrahedral_bar(2);
  EXPECT_TRUE(embed_vertices(mesh, cut_into_simplices(mesh)).empty());
}

}  // namespace
}  // namespace meshorder
