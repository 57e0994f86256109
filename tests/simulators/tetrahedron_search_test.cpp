// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/tetrahedron_search.hpp"

#include "lab/contact/geometry/box_tree.hpp"
#include "lab/contact/geometry/simplex_point.hpp"
#include "mesh/procedural.hpp"
#include "payoff/deformed.hpp"
#include "simulators/surfaces.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>
#include <limits>

namespace meshorder {
namespace {

struct SoftBody {
  std::vector<Point> points;
  Simplices simplices;
  std::vector<Index> surface;

  explicit SoftBody(const Mesh& mesh)
      : points(mesh.points),
        simplices(cut_into_simplices(mesh)),
        surface(body_surface(simplices, points).vertices) {}
};

using Motion = std::function<Point(const Point&)>;

AlignedVector<double> moved(const std::vector<Point>& points, const Motion& motion) {
  std::vector<Point> result;
  result.reserve(points.size());
  for (const Point& p : points) result.push_back(motion(p));
  return padded_positions(result);
}

/// The search by testing every vertex of the surface against every tetrahedron.
std::vector<VertexInside> by_all_pairs(const SoftBody& body, const TetrahedronSearch& search,
                                       std::span<const double> positions) {
  std::vector<VertexInside> result;
  for (const Index v : body.surface) {
    for (Index t = 0; t < static_cast<Index>(body.simplices.size()); ++t) {
      const std::array<Index, 4> corners = search.corners(t);
      if (std::find(corners.begin(), corners.end(), v) != corners.end()) continue;
      std::array<Point, 4> at{};
      for (int k = 0; k < 4; ++k) at[k] = point_of(positions, corners[k]);
      if (const auto weights = weights_inside(point_of(positions, v), at)) result.push_back({v, t, *weights});
    }
  }
  return result;
}

void expect_same(const std::vector<VertexInside>& actual, const std::vector<VertexInside>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_EQ(actual[i].vertex, expected[i].vertex);
    EXPECT_EQ(actual[i].tetrahedron, expected[i].tetrahedron);
    EXPECT_EQ(actual[i].weights, expected[i].weights);
  }
}

/// Rolls a body along x up to a scroll whose layers overlap.
Point rolled(const Point& p) {
  const double angle = 9.0 * p[0];
  const double radius = 0.3 - 0.05 * p[0] + 0.5 * p[1];
  return {radius * std::cos(angle), radius * std::sin(angle), p[2]};
}

/// Pulls either half of a torus through the other; at the seam it is inside out.
Point pressed(const Point& p) { return {p[0], p[1] - 0.85 * std::tanh(3.0 * p[1]), p[2]}; }

Motion shaken(double amplitude, std::uint64_t seed) {
  const auto random = std::make_shared<Random>(seed);
  return [=](const Point& p) { return plus_scaled(p, amplitude, test::random_point(*random, 1.0)); };
}

Point turned(const Point& p) {
  return {0.6 * p[0] - 0.8 * p[1] + 30.0, 0.8 * p[0] + 0.6 * p[1] - 20.0, p[2] + 10.0};
}

TEST(WeightsInside, AreBarycentricWhereStrictlyInside) {
  const std::array<Point, 4> unit{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const auto weights = weights_inside({0.1, 0.2, 0.3}, unit);
  ASSERT_TRUE(weights);
  EXPECT_NEAR((*weights)[0], 0.4, 1e-15);
  EXPECT_NEAR((*weights)[1], 0.1, 1e-15);
  EXPECT_NEAR((*weights)[2], 0.2, 1e-15);
  EXPECT_NEAR((*weights)[3], 0.3, 1e-15);
  EXPECT_FALSE(weights_inside({0.1, 0.2, 0.0}, unit)) << "on a face";
  EXPECT_FALSE(weights_inside({0.1, 0.2, 1e-9}, unit)) << "as good as on a face";
  EXPECT_TRUE(weights_inside({0.1, 0.2, 1e-5}, unit));
  EXPECT_FALSE(weights_inside({0, 0, 0}, unit));
  EXPECT_FALSE(weights_inside({0.4, 0.4, 0.3}, unit)) << "in the box alone";
  EXPECT_FALSE(weights_inside({0.1, std::numeric_limits<double>::quiet_NaN(), 0.3}, unit));
  std::array<Point, 4> turned_over = unit;
  std::swap(turned_over[1], turned_over[2]);
  EXPECT_FALSE(weights_inside({0.1, 0.2, 0.3}, turned_over)) << "inside out";
  std::array<Point, 4> flat = unit;
  flat[3] = {0.3, 0.3, 1e-13};
  EXPECT_FALSE(weights_inside({0.3, 0.3, 0.5e-13}, flat));
}

TEST(TetrahedronSearch, FindsWhatAllPairsFind) {
  const SoftBody torus(make_torus({.size = 3}));
  const SoftBody grid(make_grid({.size = 7}));
  const SoftBody small(make_grid({.size = 1}));
  std::size_t found = 0;
  for (const SoftBody* body : {&torus, &grid, &small}) {
    TetrahedronSearch search(body->simplices, body->points, body->surface);
    std::vector<VertexInside> inside{{7, 7, {}}};  // earlier entries are removed
    // one after another with the same search: nothing of an earlier motion may remain
    for (const Motion& motion : std::vector<Motion>{
             [](const Point& p) { return p; }, turned, rolled, pressed, shaken(0.03, 1), shaken(0.5, 2),
             rolled, turned, [](const Point& p) { return scaled(1e-12, rolled(p)); },
             [](const Point& p) { return scaled(1e12, rolled(p)); }, [](const Point&) { return Point{}; }}) {
      const AlignedVector<double> positions = moved(body->points, motion);
      search.find(positions, inside);
      expect_same(inside, by_all_pairs(*body, search, positions));
      found += inside.size();
    }
  }
  EXPECT_GT(found, 5000);
}

TEST(TetrahedronSearch, FindsWhatMovesByLittleIntoWhatWasNear) {
  const Mesh grid = make_grid({.size = 6});
  SoftBody body(grid);
  const Index n = index_size(body.points);
  const Simplices one = body.simplices;
  for (const Point& p : grid.points) body.points.push_back(plus_scaled(p, 1.01, {0, 1, 0}));
  for (const Index v : one.vertices) body.simplices.vertices.push_back(v + n);
  body.surface = body_surface(body.simplices, body.points).vertices;
  TetrahedronSearch search(body.simplices, body.points, body.surface);
  std::vector<VertexInside> inside;
  std::size_t found = 0;
  for (const double shift : {0.0, 0.009, 0.012, 0.02, 0.04}) {
    std::vector<Point> points = body.points;
    for (Index v = n; v < 2 * n; ++v) points[v] = plus_scaled(points[v], -shift, {0.3, 1, 0.2});
    const AlignedVector<double> positions = padded_positions(points);
    search.find(positions, inside);
    expect_same(inside, by_all_pairs(body, search, positions));
    EXPECT_EQ(inside.empty(), shift < 0.01);
    found += inside.size();
  }
  EXPECT_GT(found, 150);
}

TEST(TetrahedronSearch, FindsWhatSmallMotionsPutInNeighbours) {
  const SoftBody grid(make_grid({.size = 9}));
  TetrahedronSearch search(grid.simplices, grid.points, grid.surface);
  std::vector<VertexInside> inside;
  std::size_t found = 0;
  for (const double amplitude : {0.02, 0.04, 0.06, 0.08}) {
    const AlignedVector<double> positions = moved(grid.points, shaken(amplitude, 5));
    search.find(positions, inside);
    expect_same(inside, by_all_pairs(grid, search, positions));
    found += inside.size();
  }
  EXPECT_GT(found, 20);
}

TEST(TetrahedronSearch, FindsNothingInABodyAtRestHoweverItIsTurned) {
  const SoftBody torus(make_torus({.size = 4}));
  TetrahedronSearch search(torus.simplices, torus.points, torus.surface);
  std::vector<VertexInside> inside;
  search.find(padded_positions(torus.points), inside);
  EXPECT_TRUE(inside.empty());
  search.find(moved(torus.points, turned), inside);
  EXPECT_TRUE(inside.empty());
}

TEST(TetrahedronSearch, FindsTheSameWithEachInstructionSetAndAnyNumberOfThreads) {
  const SoftBody torus(make_torus({.size = 6}));
  TetrahedronSearch search(torus.simplices, torus.points, torus.surface);
  for (const Motion& motion : std::vector<Motion>{pressed, shaken(0.05, 3)}) {
    const AlignedVector<double> positions = moved(torus.points, motion);
    std::vector<VertexInside> expected;
    search.find(positions, expected);
    EXPECT_GT(expected.size(), 50);
    std::vector<VertexInside> inside;
    test::for_each_target([&](const char* /*target*/) {
      search.find(positions, inside);
      expect_same(inside, expected);
    });
    for (const std::size_t threads : {1, 2, 5}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      search.find(positions, inside);
      expect_same(inside, expected);
    }
  }
}

TEST(TetrahedronSearch, DoesNotDependOnHowTetrahedraTurn) {
  const SoftBody torus(make_torus({.size = 3}));
  SoftBody other = torus;
  for (std::size_t t = 0; t < other.simplices.vertices.size(); t += 8)
    std::swap(other.simplices.vertices[t], other.simplices.vertices[t + 2]);
  const AlignedVector<double> positions = moved(torus.points, pressed);
  std::vector<VertexInside> inside;
  std::vector<VertexInside> expected;
  TetrahedronSearch(torus.simplices, torus.points, torus.surface).find(positions, expected);
  TetrahedronSearch(other.simplices, other.points, other.surface).find(positions, inside);
  ASSERT_EQ(inside.size(), expected.size());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    EXPECT_EQ(inside[i].vertex, expected[i].vertex);
    EXPECT_EQ(inside[i].tetrahedron, expected[i].tetrahedron);
  }
}

TEST(TetrahedronSearch, PassesOverWhatIsNotFinite) {
  const SoftBody torus(make_torus({.size = 3}));
  TetrahedronSearch search(torus.simplices, torus.points, torus.surface);
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Random random(4);
  std::vector<VertexInside> inside;
  for (const double bad : {nan, infinity, -infinity, 1e300, -1e60}) {
    AlignedVector<double> positions = moved(torus.points, pressed);
    for (int i = 0; i < 20; ++i) positions[4 * random.below(torus.points.size()) + random.below(3)] = bad;
    search.find(positions, inside);
    expect_same(inside, by_all_pairs(torus, search, positions));
    EXPECT_GT(inside.size(), 10);
  }
  search.find(AlignedVector<double>(4 * torus.points.size(), nan), inside);
  EXPECT_TRUE(inside.empty());
}

TEST(TetrahedronSearch, TakesNothingAndFlatTetrahedra) {
  std::vector<VertexInside> inside;
  TetrahedronSearch({}, {}, {}).find({}, inside);
  EXPECT_TRUE(inside.empty());
  // a flat tetrahedron, and one that contains a vertex of the flat one
  const std::vector<Point> points{{0, 0, 0},       {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                  {0.1, 0.1, 0.1}, {2, 0, 0}, {0, 2, 0}};
  const Simplices simplices{3, {1, 4, 5, 5, 0, 1, 2, 3, 0, 1, 2, 6}, {0, 1, 2}};
  const std::vector<Index> all{0, 1, 2, 3, 4, 5, 6};
  TetrahedronSearch search(simplices, points, all);
  search.find(padded_positions(points), inside);
  ASSERT_EQ(inside.size(), 1);
  EXPECT_EQ(inside[0].vertex, 4);
  EXPECT_EQ(inside[0].tetrahedron, 1);
  EXPECT_GT(search.bytes(), 0);
}

}  // namespace
}  // namespace meshorder
