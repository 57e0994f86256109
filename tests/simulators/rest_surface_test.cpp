// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/rest_surface.hpp"

#include "mesh/procedural.hpp"
#include "simulators/surfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace meshorder {
namespace {

TEST(RestSurface, OfTrianglesThatMeetThereTakesTheOneThatFacesMost) {
  // a roof with its ridge along z, whose right side is steeper, and a point above the right side
  const std::vector<Point> points{{0, 0, 0}, {0, 0, 1}, {-1, -0.2, 0.5}, {1, -2, 0.5}};
  const Point x{0.3, 0.9, 0.5};
  for (const bool turned : {false, true}) {
    std::vector<std::array<Index, 3>> triangles{{0, 1, 2}, {1, 0, 3}};
    if (turned) std::swap(triangles[0], triangles[1]);
    const RestSurface surface(triangles, points);
    const RestSurface::Place place = surface.nearest(x);
    EXPECT_EQ(surface.triangle(place.triangle)[2], 2)
        << "|(0.3, 0.9) · (0.2, −1)| > |(0.3, 0.9) · (2, 1)| / √5";
    EXPECT_NEAR(place.distance, std::hypot(0.3, 0.9), 1e-15);
    EXPECT_NEAR(place.weights[0], 0.5, 1e-15);
    EXPECT_EQ(place.weights[2], 0.0);
  }
}

TEST(RestSurface, FindsTheSamePlaceHoweverTrianglesAreNumbered) {
  const test::Surface torus = test::surface_of(make_torus({.size = 4}));
  std::vector<std::array<Index, 3>> turned = torus.triangles;
  std::reverse(turned.begin(), turned.end());
  const RestSurface surface(torus.triangles, torus.points);
  const RestSurface other(turned, torus.points);
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Point x = test::random_point(random, 1.2);
    const RestSurface::Place place = surface.nearest(x);
    EXPECT_EQ(surface.triangle(place.triangle), other.triangle(other.nearest(x).triangle));
    EXPECT_NEAR(place.distance, test::distance_to_surface(torus, x), 1e-12);
    const RestSurface::Place hinted = surface.nearest(x, RestSurface::kNone, 1.001 * place.distance);
    EXPECT_EQ(hinted.triangle, place.triangle);
    EXPECT_EQ(hinted.weights, place.weights);
  }
}

TEST(RestSurface, LeavesOutTrianglesOfAVertex) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  const RestSurface surface({{0, 1, 2}, {3, 4, 5}}, points);
  EXPECT_EQ(surface.nearest({0.2, 0.2, 1}).triangle, 0);
  EXPECT_EQ(surface.nearest({0.2, 0.2, 1}, 2).triangle, 1);
  EXPECT_EQ(RestSurface({{0, 1, 2}}, points).nearest({0.2, 0.2, 1}, 2).triangle, RestSurface::kNone);
}

}  // namespace
}  // namespace meshorder
