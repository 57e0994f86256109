// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/body_surface.hpp"

#include "base/index.hpp"
#include "mesh/procedural.hpp"
#include "simulators/surfaces.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <map>

namespace meshorder {
namespace {

double volume_within(const BodySurface& surface, std::span<const Point> points) {
  double sum = 0.0;
  for (const auto& t : surface.triangles) sum += dot(points[t[0]], cross(points[t[1]], points[t[2]])) / 6.0;
  return sum;
}

double volume_of(const Simplices& simplices, std::span<const Point> points) {
  const RestShapes rest = rest_shapes(simplices, points);
  double sum = 0.0;
  for (Offset s = 0; s < rest.count; ++s) sum += rest.volume(s);
  return sum;
}

/// How many triangles have each edge in this direction.
std::map<std::pair<Index, Index>, int> edges_of(const BodySurface& surface) {
  std::map<std::pair<Index, Index>, int> edges;
  for (const auto& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  return edges;
}

TEST(BodySurface, IsClosedAndTurnsOutward) {
  for (const Mesh& mesh : {make_grid({.size = 4}), make_ball({.size = 4}), make_torus({.size = 3})}) {
    const Simplices simplices = cut_into_simplices(mesh);
    const BodySurface surface = body_surface(simplices, mesh.points);
    EXPECT_NEAR(volume_within(surface, mesh.points), volume_of(simplices, mesh.points), 1e-12);
    const auto edges = edges_of(surface);
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
  }
}

TEST(BodySurface, OfACubeOfCubesIsThatOfTheCube) {
  const Mesh mesh = make_grid({.size = 5});
  const BodySurface surface = body_surface(cut_into_simplices(mesh), mesh.points);
  EXPECT_EQ(surface.triangles.size(), 6 * 25 * 2);
  EXPECT_EQ(surface.vertices.size(), 6 * 6 * 6 - 4 * 4 * 4);
  EXPECT_TRUE(std::is_sorted(surface.vertices.begin(), surface.vertices.end()));
  EXPECT_EQ(std::adjacent_find(surface.vertices.begin(), surface.vertices.end()), surface.vertices.end());
}

TEST(BodySurface, HasAllComponentsAndCavities) {
  const Mesh mesh = make_grid({.size = 3});
  Simplices simplices = cut_into_simplices(mesh);
  // without the cube in the middle, and with a separate tetrahedron
  simplices.vertices.erase(simplices.vertices.begin() + 4 * 6 * 13, simplices.vertices.begin() + 4 * 6 * 14);
  std::vector<Point> points = mesh.points;
  const Index first = index_size(points);
  points.insert(points.end(), {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}});
  simplices.vertices.insert(simplices.vertices.end(), {first, first + 1, first + 2, first + 3});
  const BodySurface surface = body_surface(simplices, points);
  EXPECT_EQ(surface.triangles.size(), 6 * 9 * 2 + 6 * 2 + 4);
  EXPECT_EQ(surface.vertices.size(), 4 * 4 * 4 + 4);
  EXPECT_NEAR(volume_within(surface, points), volume_of(simplices, points), 1e-12);
}

TEST(BodySurface, DoesNotDependOnHowTetrahedraTurn) {
  const Mesh mesh = make_ball({.size = 3});
  Simplices simplices = cut_into_simplices(mesh);
  for (std::size_t t = 0; t < simplices.vertices.size(); t += 12)
    std::swap(simplices.vertices[t], simplices.vertices[t + 2]);
  EXPECT_NEAR(volume_within(body_surface(simplices, mesh.points), mesh.points),
              volume_of(simplices, mesh.points), 1e-12);
}

TEST(BodySurface, OfNothingIsNothing) {
  EXPECT_TRUE(body_surface({}, {}).triangles.empty());
  EXPECT_TRUE(body_surface({}, {}).vertices.empty());
}

TEST(BodySurface, RefusesWhatIsNoTetrahedron) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_THROW(body_surface({2, {0, 1, 2}, {0}}, points), InvalidArgument);
  EXPECT_THROW(body_surface({3, {0, 1, 2, 4}, {0}}, points), InvalidArgument);
  EXPECT_THROW(body_surface({3, {0, 1, -1, 3}, {0}}, points), InvalidArgument);
  EXPECT_EQ(body_surface({3, {0, 1, 2, 3}, {0}}, points).triangles.size(), 4);
}

}  // namespace
}  // namespace meshorder
