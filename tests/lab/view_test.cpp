// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "lab/contact/search/body_surface.hpp"
#include "lab/report/page/page_parts.hpp"
#include "mesh/procedural.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kAll = kMaxIndex / 3;

/// Whether each side of a triangle occurs once, and once in the opposite direction in another triangle.
bool is_closed(const SurfaceView& view) {
  std::map<std::pair<Index, Index>, int> sides;
  for (const auto& triangle : view.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++sides[{triangle[k], triangle[(k + 1) % 3]}];
  }
  return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
    const auto other = sides.find({side.first.second, side.first.first});
    return side.second == 1 && other != sides.end() && other->second == 1;
  });
}

/// The enclosed volume by the divergence theorem; positive if triangles face outward.
double enclosed_volume(const SurfaceView& view, const Mesh& mesh) {
  double six_fold = 0;
  for (const auto& triangle : view.triangles) {
    const Point& a = mesh.points[view.vertices[triangle[0]]];
    const Point& b = mesh.points[view.vertices[triangle[1]]];
    const Point& c = mesh.points[view.vertices[triangle[2]]];
    six_fold += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six_fold / 6;
}

double volume(const Mesh& mesh) {
  const RestShapes shapes = rest_shapes(cut_into_simplices(mesh), mesh.points);
  double sum = 0;
  for (Offset s = 0; s < shapes.count; ++s) sum += shapes.volume(s);
  return sum;
}

Index euler_characteristic(const SurfaceView& view) {
  std::set<std::pair<Index, Index>> edges;
  for (const auto& triangle : view.triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(triangle[k], triangle[(k + 1) % 3]));
  }
  return index_size(view.vertices) - index_size(edges) + index_size(view.triangles);
}

/// The unit cube as n³ hexahedra, every second one with reversed orientation.
Mesh cube_of_hexahedra(Index n) {
  Mesh mesh;
  const auto number = [&](Index i, Index j, Index k) { return (i * (n + 1) + j) * (n + 1) + k; };
  for (Index i = 0; i <= n; ++i) {
    for (Index j = 0; j <= n; ++j) {
      for (Index k = 0; k <= n; ++k) mesh.points.push_back({1.0 * i / n, 1.0 * j / n, 1.0 * k / n});
    }
  }
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      for (Index k = 0; k < n; ++k) {
        std::vector<Index> cell{number(i, j, k),
                                number(i + 1, j, k),
                                number(i + 1, j + 1, k),
                                number(i, j + 1, k),
                                number(i, j, k + 1),
                                number(i + 1, j, k + 1),
                                number(i + 1, j + 1, k + 1),
                                number(i, j + 1, k + 1)};
        if ((i + j + k) % 2 == 1) std::rotate(cell.begin(), cell.begin() + 4, cell.end());
        mesh.cells.push_back(Shape::hexahedron, cell);
      }
    }
  }
  return mesh;
}

TEST(SurfaceView, OfTetrahedraIsClosedAndEnclosesTheirVolume) {
  const Mesh mesh = make_torus({.size = 5});
  const SurfaceView view = surface_view(mesh, kAll);
  EXPECT_TRUE(is_closed(view));
  EXPECT_NEAR(enclosed_volume(view, mesh), volume(mesh), 1e-12);
  EXPECT_EQ(euler_characteristic(view), 0);
  const BodySurface faces = body_surface(cut_into_simplices(mesh), mesh.points);
  EXPECT_EQ(view.triangles.size(), faces.triangles.size());
  std::vector<Index> vertices = view.vertices;
  std::sort(vertices.begin(), vertices.end());
  EXPECT_EQ(vertices, faces.vertices);
}

TEST(SurfaceView, FacesOutwardsWhicheverWayCellsTurn) {
  const Mesh mesh = cube_of_hexahedra(3);
  const SurfaceView view = surface_view(mesh, kAll);
  EXPECT_EQ(view.triangles.size(), 6 * 9 * 2U);
  EXPECT_TRUE(is_closed(view));
  EXPECT_NEAR(enclosed_volume(view, mesh), 1, 1e-12);
}

TEST(SurfaceView, SimplifiedKeepsShapeTopologyAndVerticesOfTheMesh) {
  const Mesh ball = make_ball({.size = 24});
  const SurfaceView whole = surface_view(ball, kAll);
  const SurfaceView view = surface_view(ball, 1500);
  EXPECT_GT(whole.triangles.size(), 6000U);
  EXPECT_LE(view.triangles.size(), 1500U);
  EXPECT_GT(view.triangles.size(), 1000U);
  EXPECT_EQ(euler_characteristic(view), 2);
  EXPECT_TRUE(is_closed(view));
  EXPECT_NEAR(enclosed_volume(view, ball), 4 * std::numbers::pi / 3, 0.1);
  const std::set<Index> of_surface(whole.vertices.begin(), whole.vertices.end());
  std::set<Index> seen;
  for (const Index v : view.vertices) {
    EXPECT_TRUE(of_surface.contains(v));
    EXPECT_TRUE(seen.insert(v).second) << "vertex " << v << " stands twice";
  }
}

TEST(SurfaceView, IsTheSameOnEveryRun) {
  const Mesh ball = make_ball({.size = 12});
  EXPECT_EQ(surface_view(ball, 400).triangles, surface_view(ball, 400).triangles);
}

TEST(SurfaceView, IsAsGoodFarFromTheOrigin) {
  const Mesh ball = make_ball({.size = 12});
  Mesh moved = ball;
  for (Point& point : moved.points) {
    for (double& x : point) x += 1e9;
  }
  EXPECT_NEAR(enclosed_volume(surface_view(moved, 400), ball), 4 * std::numbers::pi / 3, 0.3);
}

TEST(SurfaceView, BecomesSmallAgainstItsTopology) {
  // triangles without shared vertices, as in STL files
  const Mesh ball = make_ball({.size = 12});
  const SurfaceView whole = surface_view(ball, kAll);
  Mesh soup;
  for (const auto& triangle : whole.triangles) {
    const Index first = soup.vertex_count();
    for (const Index corner : triangle) soup.points.push_back(ball.points[whole.vertices[corner]]);
    soup.cells.push_back(Shape::triangle, std::vector<Index>{first, first + 1, first + 2});
  }
  EXPECT_LE(surface_view(soup, 400).triangles.size(), 800U);
}

TEST(SurfaceView, OfASurfaceIsItsTriangles) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {9, 9, 9}};
  mesh.cells.push_back(Shape::quad, std::vector<Index>{0, 1, 2, 3});
  mesh.cells.push_back(Shape::line, std::vector<Index>{0, 4});
  const SurfaceView view = surface_view(mesh, kAll);
  EXPECT_EQ(view.triangles.size(), 2U);
  EXPECT_EQ(view.vertices.size(), 4U);
}

TEST(SurfaceView, IsOpenWherePolyhedraAre) {
  Mesh mesh;  // a cube, and a polyhedron with unknown faces above it
  for (const double z : {0.0, 1.0, 2.0}) {
    for (const auto& [x, y] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
      mesh.points.push_back({x, y, z});
  }
  mesh.cells.push_back(Shape::hexahedron, index_range(0, 8));
  mesh.cells.push_back(Shape::polyhedron, index_range(4, 8));
  const SurfaceView view = surface_view(mesh, kAll);
  EXPECT_EQ(view.triangles.size(), 10U) << "the face between the two is none of the surface";
  EXPECT_TRUE(surface_view(test::cells_of_type(Shape::polyhedron, 8, 2), kAll).triangles.empty());
}

TEST(SurfaceView, OfLinesIsAnError) {
  EXPECT_THROW((void)surface_view(test::cells_of_type(Shape::line, 2, 3), 10), InputError);
}

}  // namespace
}  // namespace meshorder
