// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/obstacles/obstacle.hpp"

#include "mesh/procedural.hpp"
#include "simulators/surfaces.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace meshorder {
namespace {

constexpr double kFar = 1e9;
const double kNan = std::numeric_limits<double>::quiet_NaN();

/// EXPECTs that `nearest` and `distance` agree around the origin: the point is on the surface at that
/// distance along the normal, and the distance grows along the normal by the path length.
void expect_consistent(const Obstacle& obstacle, double size, std::uint64_t seed) {
  constexpr double kStep = 1e-6;
  Random random(seed);
  int steep = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point x = test::random_point(random, size);
    const auto place = obstacle.nearest(x, x, kFar);
    ASSERT_TRUE(place);
    ASSERT_NEAR(norm(place->normal), 1.0, 1e-12);
    ASSERT_NEAR(place->distance, obstacle.distance(x), 1e-12 * size);
    ASSERT_NEAR(obstacle.distance(place->at), 0.0, 1e-9 * size);
    ASSERT_NEAR(norm(minus(x, plus_scaled(place->at, place->distance, place->normal))), 0.0, 1e-9 * size);
    const double slope = (obstacle.distance(plus_scaled(x, kStep, place->normal)) -
                          obstacle.distance(plus_scaled(x, -kStep, place->normal))) /
                         (2 * kStep);
    if (slope > 1.0 - 1e-3) ++steep;  // not where two nearest points are equally near
    // points outside are found up to the reach, points inside at any distance
    const double d = place->distance;
    EXPECT_TRUE(obstacle.nearest(x, x, std::max(d, 0.0) + 1e-9 * size));
    EXPECT_EQ(obstacle.nearest(x, x, std::abs(d) - 1e-9 * size).has_value(), d < 0.0);
  }
  EXPECT_GE(steep, 1990);
}

TEST(HalfSpace, HasTheDistanceFromItsPlane) {
  const auto floor = half_space({1, 2, 3}, {0, 10, 0});
  EXPECT_DOUBLE_EQ(floor->distance({7, 5, -4}), 3.0);
  EXPECT_DOUBLE_EQ(floor->distance({7, 1.5, -4}), -0.5);
  expect_consistent(*half_space({0.1, 0.2, 0.3}, {1, -2, 0.5}), 2.0, 1);
}

TEST(HalfSpace, LeadsBackHoweverDeep) {
  const auto place = half_space({0, 0, 0}, {0, 1, 0})->nearest({3, -50, 4}, {3, 1, 4}, 0.0);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->at, (Point{3, 0, 4}));
  EXPECT_EQ(place->distance, -50.0);
}

TEST(Sphere, HasTheDistanceFromItsSurface) {
  const auto ball = sphere({0, 0, 0}, 0.5);
  EXPECT_DOUBLE_EQ(ball->distance({0, 3, 4}), 4.5);
  EXPECT_DOUBLE_EQ(ball->distance({0, 0, 0}), -0.5);
  expect_consistent(*ball, 1.0, 2);
  EXPECT_NEAR(norm(ball->nearest({0, 0, 0}, {0, 0, 0}, 0.0)->normal), 1.0, 1e-15);
}

TEST(Sphere, LeadsBackWhatWentPastItsMiddle) {
  const auto ball = sphere({1, 0, 0}, 0.5);
  for (const double x : {1.1, 1.4, 1.6, 9.0}) {  // within, and out again
    const auto place = ball->nearest({x, 0.1, 0}, {0, 0.1, 0}, 0.0);
    ASSERT_TRUE(place) << x;
    EXPECT_NEAR(norm(minus(place->at, {1 - std::sqrt(0.24), 0.1, 0})), 0.0, 1e-12);
    EXPECT_LT(place->distance, 0.0);
    EXPECT_LT(place->normal[0], 0.0);
  }
  // a point that passes by
  EXPECT_FALSE(ball->nearest({3, 0.6, 0}, {0, 0.6, 0}, 0.01));
}

/// The bowl by its definition: all points within half the thickness of a sampled cap.
TEST(Bowl, IsWhatIsWithinHalfTheThicknessOfACap) {
  const double radius = 1.0;
  const double thickness = 0.2;
  const Point axis{1, 2, 2};
  for (const double opening : {0.0, 0.4, 1.5, 2.8}) {
    const auto shell = bowl({0, 0, 0}, axis, radius, thickness, opening);
    Random random(3);
    std::vector<Point> cap;
    const Point up = scaled(1.0 / 3.0, axis);
    const Point across = scaled(1.0 / std::sqrt(2.0), Point{0, 1, -1});
    const Point along = cross(up, across);
    for (int i = 0; i <= 160; ++i) {
      const double polar = opening + (std::numbers::pi - opening) * i / 160;
      for (int j = 0; j < 320; ++j) {
        const double around = 2 * std::numbers::pi * j / 320;
        Point p = scaled(radius * std::cos(polar), up);
        p = plus_scaled(p, radius * std::sin(polar) * std::cos(around), across);
        cap.push_back(plus_scaled(p, radius * std::sin(polar) * std::sin(around), along));
      }
    }
    for (int i = 0; i < 200; ++i) {
      const Point x = test::random_point(random, 1.5);
      double smallest = kFar;
      for (const Point& p : cap) smallest = std::min(smallest, norm(minus(x, p)));
      EXPECT_NEAR(shell->distance(x), smallest - 0.5 * thickness, 0.003 / (0.1 + smallest)) << opening;
      EXPECT_LE(shell->distance(x), smallest - 0.5 * thickness + 1e-12);
    }
    expect_consistent(*bowl({0, 0, 0}, axis, radius, thickness, opening), 1.5, 4);
  }
}

TEST(Bowl, LeadsBackWhatWentThroughItsWall) {
  const auto shell = bowl({0, 0, 0}, {0, 1, 0}, 1.0, 0.02, 0.5);
  struct Case {
    Point from, to, at;
  };
  for (const auto& [from, to, at] : {
           Case{{0, -0.98, 0}, {0, -1.005, 0}, {0, -0.99, 0}},  // past the middle of the wall
           Case{{0, -0.98, 0}, {0, -1.05, 0}, {0, -0.99, 0}},   // out of it
           Case{{0, -0.98, 0}, {0, -9.0, 0}, {0, -0.99, 0}},
           Case{{0, -1.02, 0}, {0, -0.9, 0}, {0, -1.01, 0}},  // the same in the other direction
           Case{{-2, 0, 0}, {2, 0, 0}, {-1.01, 0, 0}},        // through both walls
           Case{{0, -2, 0}, {0, 2, 0}, {0, -1.01, 0}},        // through one and out of the opening
       }) {
    const auto place = shell->nearest(to, from, 0.0);
    ASSERT_TRUE(place) << from[0] << ' ' << from[1] << " to " << to[1];
    EXPECT_NEAR(norm(minus(place->at, at)), 0.0, 1e-12) << from[0] << ' ' << from[1] << " to " << to[1];
    EXPECT_LT(place->distance, 0.0);
    EXPECT_NEAR(place->distance, dot(place->normal, minus(to, place->at)), 1e-12);
  }
  EXPECT_FALSE(shell->nearest({0, -0.9, 0}, {0, 2, 0}, 0.01)) << "in by the opening";
  EXPECT_FALSE(shell->nearest({0, 2, 0}, {0, -0.9, 0}, 0.01)) << "out by the opening";
}

TEST(Bowl, HasARoundRim) {
  const auto shell = bowl({0, 0, 0}, {0, 1, 0}, 1.0, 0.2, std::numbers::pi / 2);  // the lower half
  EXPECT_NEAR(shell->distance({1, 0.3, 0}), 0.2, 1e-15);
  EXPECT_NEAR(shell->distance({1.3, 0.4, 0}), 0.4, 1e-15);
  const auto place = shell->nearest({0.97, 0.04, 0}, {0.9, 0.3, 0}, 0.0);
  ASSERT_TRUE(place);
  EXPECT_NEAR(norm(minus(place->normal, {-0.6, 0.8, 0})), 0.0, 1e-12);
}

TEST(ClosedSurface, IsTheCubeThatItEncloses) {
  const test::Surface unit = test::cube();
  const auto box = closed_surface(unit.points, unit.triangles);
  Random random(5);
  for (int i = 0; i < 5000; ++i) {
    Point x = test::random_point(random, 1.5);
    for (int c = 0; c < 3; ++c) x[c] += 0.5;
    if (i % 10 == 0) x[i / 10 % 3] = 0.5;  // along the shared edge
    double outside = 0.0;
    double inside = -kFar;
    for (const double c : x) {
      const double d = std::max(-c, c - 1.0);
      outside += d > 0.0 ? d * d : 0.0;
      inside = std::max(inside, d);
    }
    ASSERT_NEAR(box->distance(x), outside > 0.0 ? std::sqrt(outside) : inside, 1e-12);
  }
  // 1.5 % of these points are about as far from two faces
  test::Surface shifted = unit;
  for (Point& p : shifted.points) p = minus(p, {0.5, 0.5, 0.5});
  expect_consistent(*closed_surface(shifted.points, shifted.triangles), 1.2, 6);
}

TEST(ClosedSurface, AgreesWithAllTrianglesAndTheWindingNumber) {
  const test::Surface torus = test::surface_of(make_torus({.size = 3}));
  const auto ring = closed_surface(torus.points, torus.triangles);
  Random random(7);
  int inside = 0;
  for (int i = 0; i < 10000; ++i) {
    Point x = test::random_point(random, 1.6);
    if (i % 2 == 0) {  // near corners and edges, where signs are hard
      const auto& t = torus.triangles[random.below(torus.triangles.size())];
      const double part = i % 4 == 0 ? 0.0 : random.unit();
      x = plus_scaled(plus_scaled(scaled(1 - part, torus.points[t[0]]), part, torus.points[t[1]]), 0.02,
                      test::random_direction(random));
    }
    const double winding = test::winding_number(torus, x);
    ASSERT_NEAR(winding, std::round(winding), 1e-6);
    const bool within = winding > 0.5;
    inside += within ? 1 : 0;
    ASSERT_NEAR(ring->distance(x), (within ? -1 : 1) * test::distance_to_surface(torus, x), 1e-12) << i;
  }
  EXPECT_GT(inside, 2000);
  EXPECT_LT(inside, 6000);
}

TEST(ClosedSurface, KnowsTheSideAtSpikesAndInNotches) {
  test::Surface spiky = test::surface_of(make_ball({.size = 3}));
  Random random(8);
  for (Point& p : spiky.points) p = scaled(0.15 + 0.85 * random.unit(), p);  // still seen from the middle
  const auto star = closed_surface(spiky.points, spiky.triangles);
  for (int i = 0; i < 3000; ++i) {
    const auto& t = spiky.triangles[random.below(spiky.triangles.size())];
    const Point x = plus_scaled(spiky.points[t[0]], 0.1 * random.unit(), test::random_direction(random));
    const bool within = test::winding_number(spiky, x) > 0.5;
    ASSERT_NEAR(star->distance(x), (within ? -1 : 1) * test::distance_to_surface(spiky, x), 1e-12) << i;
  }
}

TEST(ClosedSurface, LeadsBackWhatWentThroughIt) {
  test::Surface plate = test::cube();
  for (Point& p : plate.points) p[1] *= 0.01;
  const auto wall = closed_surface(plate.points, plate.triangles);
  const double x = 0.4;
  for (const double from : {0.05, 0.01, 0.01 - 1e-6}) {  // above, on it, and in it by a tolerance
    for (const double to : {0.004, -0.001, -0.05}) {
      const auto place = wall->nearest({x, to, 0.3}, {x, from, 0.3}, 0.0);
      ASSERT_TRUE(place) << from << ' ' << to;
      EXPECT_NEAR(norm(minus(place->at, {x, 0.01, 0.3})), 0.0, 1e-8) << from << ' ' << to;
      EXPECT_EQ(place->normal, (Point{0, 1, 0}));
      EXPECT_NEAR(place->distance, to - 0.01, 1e-8);
    }
    // vertices that leave or slide along are not stopped
    EXPECT_FALSE(wall->nearest({x, 0.02, 0.3}, {x, from, 0.3}, 0.0)) << from;
    EXPECT_FALSE(wall->nearest({0.9, 0.0101, 0.9}, {x, from, 0.3}, 0.0)) << from;
  }
  EXPECT_FALSE(wall->nearest({1.5, -0.2, 0.5}, {1.5, 0.2, 0.5}, 0.0)) << "past the edge";
  const auto near = wall->nearest({x, 0.0101, 0.3}, {0.9, 0.01, 0.9}, 0.001);
  ASSERT_TRUE(near) << "slides along, within reach";
  EXPECT_NEAR(near->distance, 0.0001, 1e-12);
}

TEST(ClosedSurface, TakesRoundingForNoPassage) {
  const test::Surface unit = test::cube();
  const auto box = closed_surface(unit.points, unit.triangles);
  // a path over the edge at x = 1, which it cuts by 3e-10
  const Point from{0.5, 1 + 2e-9, 0.5};
  EXPECT_FALSE(box->nearest({2.0, 1 - 5e-9, 0.5}, from, 0.0));
  EXPECT_TRUE(box->nearest({2.0, 1 - 5e-6, 0.5}, from, 0.0)) << "by 1e-6";
}

/// Returns the message of the error that building the surface throws.
std::string refusal(const test::Surface& surface) {
  try {
    closed_surface(surface.points, surface.triangles);
  } catch (const InvalidArgument& refused) {
    return refused.what();
  }
  return "not refused";
}

TEST(ClosedSurface, RefusesWhatIsNotClosedAndOrientedByAnEdge) {
  const auto names = [](const std::string& what, const std::string& part) {
    return what.find(part) != std::string::npos ? "" : what;
  };
  test::Surface open = test::cube();
  open.triangles.pop_back();
  EXPECT_EQ(names(refusal(open), "only one triangle has the edge between points 1 and 5"), "");
  test::Surface turned = test::cube();
  std::swap(turned.triangles[0][1], turned.triangles[0][2]);
  EXPECT_EQ(names(refusal(turned), "more than one triangle has the edge from point 0 to point"), "");
  test::Surface inside_out = test::cube();
  for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(names(refusal(inside_out), "inside out"), "");
  test::Surface outside = test::cube();
  outside.triangles[3][1] = 8;
  EXPECT_EQ(names(refusal(outside), "triangle 3 names point 8, but points are 0 to 7"), "");
  test::Surface infinite = test::cube();
  infinite.points[2][1] = kNan;
  EXPECT_EQ(names(refusal(infinite), "point 2 is not finite"), "");
  test::Surface twice = test::cube();
  twice.triangles[0][1] = twice.triangles[0][0];
  EXPECT_EQ(names(refusal(twice), "triangle 0 has point 0 at two corners"), "");
  EXPECT_EQ(names(refusal({}), "no triangles"), "");
}

TEST(Obstacles, SayNothingOfPointsThatAreNotFinite) {
  const test::Surface unit = test::cube();
  const std::array<std::unique_ptr<Obstacle>, 4> all{half_space({0, 0, 0}, {0, 1, 0}), sphere({0, 0, 0}, 1),
                                                     bowl({0, 0, 0}, {0, 1, 0}, 1, 0.1, 1),
                                                     closed_surface(unit.points, unit.triangles)};
  for (const auto& obstacle : all) {
    EXPECT_FALSE(obstacle->nearest({kNan, 0, 0}, {0, 3, 0}, kFar));
    EXPECT_FALSE(obstacle->nearest({kNan, kNan, kNan}, {kNan, kNan, kNan}, kFar));
    EXPECT_TRUE(obstacle->nearest({0, 3, 0}, {kNan, 0, 0}, kFar));
  }
}

TEST(Obstacles, RefuseShapesThatAreNone) {
  EXPECT_THROW(half_space({0, 0, 0}, {0, 0, 0}), InvalidArgument);
  EXPECT_THROW(half_space({0, kNan, 0}, {0, 1, 0}), InvalidArgument);
  EXPECT_THROW(sphere({0, 0, 0}, 0.0), InvalidArgument);
  EXPECT_THROW(sphere({0, 0, 0}, kNan), InvalidArgument);
  EXPECT_THROW(bowl({0, 0, 0}, {0, 0, 0}, 1, 0.1, 1), InvalidArgument);
  EXPECT_THROW(bowl({0, 0, 0}, {0, 1, 0}, 1, 0.0, 1), InvalidArgument);
  EXPECT_THROW(bowl({0, 0, 0}, {0, 1, 0}, 1, 2.0, 1), InvalidArgument);
  EXPECT_THROW(bowl({0, 0, 0}, {0, 1, 0}, 1, 0.1, 4), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
