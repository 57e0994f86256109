// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/contact_finder.hpp"

#include "kernels/positions.hpp"
#include "lab/contact/search/tetrahedron_search.hpp"
#include "mesh/procedural.hpp"
#include "simulators/surfaces.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>

namespace meshorder {
namespace {

struct SoftBody {
  std::vector<Point> points;
  Simplices simplices;
};

SoftBody body_of(const Mesh& mesh) { return {mesh.points, cut_into_simplices(mesh)}; }

/// Two unit cubes, the second one 3 further along x.
SoftBody two_cubes() {
  const Mesh cube = make_grid({.size = 4});
  SoftBody body = body_of(cube);
  const Index n = index_size(body.points);
  const Simplices one = body.simplices;
  for (const Point& p : cube.points) body.points.push_back(plus_scaled(p, 3.0, {1, 0, 0}));
  for (const Index v : one.vertices) body.simplices.vertices.push_back(v + n);
  return body;
}

/// The cubes with the second one turned slightly about y, and sunk into the first from above.
AlignedVector<double> stacked(const SoftBody& body, double depth) {
  AlignedVector<double> positions = padded_positions(body.points);
  for (std::size_t v = body.points.size() / 2; v < body.points.size(); ++v) {
    const Point& p = body.points[v];
    positions[4 * v] = 0.98 * (p[0] - 3.0) + 0.1 * p[2] + 0.03;
    positions[4 * v + 1] = p[1] + 1.0 - depth;
    positions[4 * v + 2] = 0.98 * p[2] - 0.1 * (p[0] - 3.0) + 0.04;
  }
  return positions;
}

ContactOptions with_itself() {
  ContactOptions options;
  options.with_itself = true;
  return options;
}

/// normal · Σ weights x, less the offset: negative where violated.
double gap(const Contact& contact, std::span<const double> positions) {
  double sum = -contact.offset;
  for (int k = 0; k < 4; ++k) {
    if (contact.vertices[k] != Contact::kAbsent)
      sum += contact.weights[k] * dot(contact.normal, point_of(positions, contact.vertices[k]));
  }
  return sum;
}

void expect_same(const std::vector<Contact>& actual, const std::vector<Contact>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_EQ(actual[i].vertices, expected[i].vertices);
    EXPECT_EQ(actual[i].weights, expected[i].weights);
    EXPECT_EQ(actual[i].normal, expected[i].normal);
    EXPECT_EQ(actual[i].offset, expected[i].offset);
    EXPECT_EQ(actual[i].friction, expected[i].friction);
    EXPECT_EQ(actual[i].with, expected[i].with);
  }
}

TEST(SelfContact, LeadsOutThroughTheNearestFace) {
  constexpr double kDepth = 0.06;
  const SoftBody body = two_cubes();
  ContactOptions options = with_itself();
  options.friction_with_itself = 0.25;
  ContactFinder finder(body.simplices, body.points, options);
  const AlignedVector<double> positions = stacked(body, kDepth);
  std::vector<Contact> contacts;
  finder.find(positions, positions, contacts);
  int up = 0;
  int down = 0;
  for (const Contact& contact : contacts) {
    EXPECT_TRUE(contact.is_with_itself());
    EXPECT_EQ(contact.with, -1);
    EXPECT_EQ(contact.friction, 0.25);
    EXPECT_EQ(contact.weights[0], 1.0);
    EXPECT_NEAR(contact.weights[1] + contact.weights[2] + contact.weights[3], -1.0, 1e-12);
    for (int k = 1; k < 4; ++k) EXPECT_LE(contact.weights[k], 0.0);
    EXPECT_NEAR(norm(contact.normal), 1.0, 1e-12);
    if (std::abs(contact.normal[1]) < 0.9) continue;  // near the cubes' edges the sides are nearer
    const bool of_upper = contact.vertices[0] >= index_size(body.points) / 2;
    ++(of_upper ? up : down);
    EXPECT_NEAR(contact.normal[1], of_upper ? 1.0 : -1.0, 1e-12);
    EXPECT_NEAR(gap(contact, positions), -kDepth, 1e-12);
  }
  EXPECT_GE(up, 9);
  EXPECT_GE(down, 9);

  const Penetration penetration = finder.penetration(positions);
  EXPECT_EQ(penetration.vertices_in_itself, index_size(contacts));
  EXPECT_EQ(penetration.into_obstacles, 0.0);
}

TEST(SelfContact, OfWhatTouchesIsNone) {
  const SoftBody body = two_cubes();
  ContactFinder finder(body.simplices, body.points, with_itself());
  std::vector<Contact> contacts;
  for (const double depth : {0.0, 1e-9, -0.1}) {
    const AlignedVector<double> positions = stacked(body, depth);
    finder.find(positions, positions, contacts);
    EXPECT_TRUE(contacts.empty()) << depth;
    EXPECT_EQ(finder.penetration(positions).vertices_in_itself, 0);
  }
}

TEST(SelfContact, IsThatOfTheDeepestTetrahedronByAllTriangles) {
  const SoftBody body = body_of(make_torus({.size = 3}));
  const BodySurface surface = body_surface(body.simplices, body.points);
  TetrahedronSearch search(body.simplices, body.points, surface.vertices);
  ContactFinder finder(body.simplices, body.points, with_itself());
  Random random(1);
  int several = 0;
  int near_own_place = 0;
  for (const double amplitude : {0.0, 0.1, 0.3}) {
    AlignedVector<double> positions = padded_positions(body.points);
    for (std::size_t v = 0; v < body.points.size(); ++v) {
      positions[4 * v + 1] -= 0.85 * std::tanh(3.0 * body.points[v][1]);
      for (int c = 0; c < 3; ++c) positions[4 * v + c] += amplitude * (random.unit() - 0.5);
    }
    std::vector<VertexInside> inside;
    search.find(positions, inside);
    std::vector<Contact> contacts;
    finder.find(positions, positions, contacts);
    std::size_t i = 0;
    for (std::size_t k = 0; k < inside.size(); ++i) {
      const Index v = inside[k].vertex;
      double depth = -1.0;
      std::vector<Point> places;
      for (; k < inside.size() && inside[k].vertex == v; ++k) {
        Point place{};
        for (int a = 0; a < 4; ++a)
          place =
              plus_scaled(place, inside[k].weights[a], body.points[search.corners(inside[k].tetrahedron)[a]]);
        test::Surface others{body.points, surface.triangles};
        std::erase_if(others.triangles,
                      [&](const auto& t) { return std::find(t.begin(), t.end(), v) != t.end(); });
        depth = std::max(depth, test::distance_to_surface(others, place));
        places.push_back(place);
      }
      if (places.size() > 1) ++several;
      ASSERT_LT(i, contacts.size());
      ASSERT_EQ(contacts[i].vertices[0], v);
      Point at{};
      for (int a = 1; a < 4; ++a) {
        EXPECT_NE(contacts[i].vertices[a], v);
        at = plus_scaled(at, -contacts[i].weights[a], body.points[contacts[i].vertices[a]]);
      }
      double away = 1e9;
      for (const Point& place : places) away = std::min(away, std::abs(norm(minus(at, place)) - depth));
      EXPECT_NEAR(away, 0.0, 1e-9);
      if (norm(minus(at, body.points[v])) < 0.5) ++near_own_place;
      // the normal faces outward from the deformed triangle
      const auto corner = [&](int a) { return point_of(positions, contacts[i].vertices[a]); };
      const Point normal = cross(minus(corner(2), corner(1)), minus(corner(3), corner(1)));
      EXPECT_NEAR(dot(normal, contacts[i].normal), norm(normal), 1e-12);
      EXPECT_EQ(contacts[i].offset, 0.0);
    }
    EXPECT_EQ(i, contacts.size());
    EXPECT_EQ(finder.penetration(positions).vertices_in_itself, index_size(contacts));
  }
  EXPECT_GT(several, 5);
  EXPECT_GT(near_own_place, 5);
}

TEST(ContactFinder, FindsVerticesWithinReachOfTheFloor) {
  const SoftBody body = body_of(make_grid({.size = 4}));
  ContactOptions options;
  options.obstacles.push_back({half_space({0, 0.3, 0}, {0, 1, 0}), 0.5});
  options.reach = 0.25;
  ContactFinder finder(body.simplices, body.points, options);
  const AlignedVector<double> positions = padded_positions(body.points);
  std::vector<Contact> contacts(3);
  finder.find(positions, positions, contacts);
  EXPECT_EQ(contacts.size(), 25 + 16 + 16) << "the lowest layer, and the rings of the two above";
  for (const Contact& contact : contacts) {
    EXPECT_FALSE(contact.is_with_itself());
    EXPECT_EQ(contact.normal, (Point{0, 1, 0}));
    EXPECT_DOUBLE_EQ(contact.offset, 0.3);
    EXPECT_EQ(contact.friction, 0.5);
    EXPECT_EQ(contact.with, 0);
    EXPECT_NEAR(gap(contact, positions), body.points[contact.vertices[0]][1] - 0.3, 1e-15);
  }
  EXPECT_DOUBLE_EQ(finder.penetration(positions).into_obstacles, 0.3);
}

/// Obstacles around and in the cubes, and one far away.
ContactOptions many_obstacles() {
  ContactOptions options = with_itself();
  options.obstacles.push_back({half_space({0, 0.2, 0}, {0, 1, 0}), 0.1});
  options.obstacles.push_back({sphere({0, 0.5, 0.5}, 0.3), 0.2});
  options.obstacles.push_back({bowl({0.5, 0.5, 0.5}, {0, 1, 0}, 0.72, 0.05, 1.0), 0.3});
  const test::Surface cube = test::cube();
  options.obstacles.push_back({closed_surface(cube.points, cube.triangles), 0.4});
  options.obstacles.push_back({sphere({50, 0, 0}, 1.0), 0.5});
  options.reach = 0.05;
  return options;
}

TEST(ContactFinder, FindsWhatEveryObstacleSaysOfEveryVertex) {
  const SoftBody body = two_cubes();
  const ContactOptions options = many_obstacles();
  ContactFinder finder(body.simplices, body.points, options);
  const AlignedVector<double> positions = stacked(body, 0.06);
  for (const double way : {0.0, 0.4}) {
    AlignedVector<double> from = positions;
    for (std::size_t v = 0; v < body.points.size(); ++v) from[4 * v + 1] += way;
    std::vector<Contact> contacts;
    finder.find(positions, from, contacts);
    std::size_t i = 0;
    std::size_t itself = 0;
    for (const Index v : body_surface(body.simplices, body.points).vertices) {
      for (std::size_t o = 0; o < options.obstacles.size(); ++o) {
        const auto place =
            options.obstacles[o].obstacle->nearest(point_of(positions, v), point_of(from, v), 0.05);
        if (!place) continue;
        ASSERT_LT(i, contacts.size());
        EXPECT_EQ(contacts[i].vertices, (std::array<Index, 4>{v, -1, -1, -1}));
        EXPECT_EQ(contacts[i].with, static_cast<int>(o));
        EXPECT_EQ(contacts[i].friction, options.obstacles[o].friction);
        EXPECT_EQ(contacts[i].normal, place->normal);
        EXPECT_NEAR(gap(contacts[i], positions), dot(place->normal, minus(point_of(positions, v), place->at)),
                    1e-15);
        ++i;
      }
      if (i < contacts.size() && contacts[i].vertices[0] == v && contacts[i].is_with_itself()) {
        ++i;
        ++itself;
      }
    }
    EXPECT_EQ(i, contacts.size());
    EXPECT_GT(itself, 18);
    EXPECT_GT(i, itself + 100);
  }
}

TEST(ContactFinder, FindsWhatHasGoneFarThroughAPlate) {
  const SoftBody body = two_cubes();
  test::Surface plate = test::cube();
  for (Point& p : plate.points) p = {20 * p[0] - 10, 0.01 * p[1] - 0.1, 20 * p[2] - 10};
  ContactOptions options;
  options.obstacles.push_back({closed_surface(plate.points, plate.triangles), 0.0});
  ContactFinder finder(body.simplices, body.points, options);
  const AlignedVector<double> from = padded_positions(body.points);
  AlignedVector<double> positions = from;
  for (std::size_t v = 0; v < body.points.size(); ++v) positions[4 * v + 1] -= 5.0;
  std::vector<Contact> contacts;
  finder.find(positions, from, contacts);
  EXPECT_EQ(contacts.size(), 2 * (125 - 27));
  for (const Contact& contact : contacts) EXPECT_EQ(contact.normal, (Point{0, 1, 0}));
}

TEST(ContactFinder, FindsTheSameWithAnyNumberOfThreadsAndWhateverWasAskedBefore) {
  const SoftBody body = two_cubes();
  ContactFinder finder(body.simplices, body.points, many_obstacles());
  const AlignedVector<double> from = padded_positions(body.points);
  const AlignedVector<double> positions = stacked(body, 0.06);
  std::vector<Contact> expected;
  finder.find(positions, from, expected);
  EXPECT_GT(expected.size(), 100);
  std::vector<Contact> contacts;
  for (const std::size_t threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    finder.find(from, from, contacts);
    finder.find(stacked(body, 0.5), from, contacts);
    finder.find(positions, from, contacts);
    expect_same(contacts, expected);
  }
  ContactFinder other = std::move(finder);
  other.find(positions, from, contacts);
  expect_same(contacts, expected);
  EXPECT_GT(other.bytes(), 10000);
}

TEST(ContactFinder, PassesOverPositionsThatAreNotFinite) {
  const SoftBody body = two_cubes();
  ContactFinder finder(body.simplices, body.points, many_obstacles());
  const AlignedVector<double> positions = stacked(body, 0.06);
  std::vector<Contact> contacts;
  std::vector<Contact> expected;
  finder.find(positions, positions, expected);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    AlignedVector<double> broken = positions;
    broken[4 * 7 + 1] = bad;
    finder.find(broken, positions, contacts);
    EXPECT_TRUE(
        std::none_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.vertices[0] == 7; }));
    EXPECT_GT(contacts.size(), expected.size() - 30);
    EXPECT_GT(finder.penetration(broken).into_obstacles, 0.0);
    finder.find(AlignedVector<double>(positions.size(), bad), positions, contacts);
    EXPECT_TRUE(contacts.empty());
  }
}

TEST(ContactFinder, TakesNothingAndOneTetrahedron) {
  std::vector<Contact> contacts(1);
  ContactFinder nothing({}, {}, many_obstacles());
  nothing.find({}, {}, contacts);
  EXPECT_TRUE(contacts.empty());
  EXPECT_EQ(nothing.penetration({}).into_obstacles, 0.0);

  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  ContactOptions options = with_itself();
  options.obstacles.push_back({half_space({0, 0.5, 0}, {0, 1, 0}), 0.0});
  ContactFinder finder({3, {0, 1, 2, 3}, {0}}, points, options);
  finder.find(padded_positions(points), padded_positions(points), contacts);
  ASSERT_EQ(contacts.size(), 3);
  EXPECT_EQ(contacts[1].vertices[0], 1);
  EXPECT_EQ(contacts[2].vertices[0], 3);
}

TEST(ContactFinder, RefusesWhatDoesNotFit) {
  const SoftBody body = two_cubes();
  ContactOptions missing;
  missing.obstacles.emplace_back();
  EXPECT_THROW(ContactFinder(body.simplices, body.points, missing), InvalidArgument);
  ContactOptions negative;
  negative.reach = -1.0;
  EXPECT_THROW(ContactFinder(body.simplices, body.points, negative), InvalidArgument);
  EXPECT_THROW(ContactFinder({2, {0, 1, 2}, {0}}, body.points, {}), InvalidArgument);
  ContactFinder finder(body.simplices, body.points, {});
  const AlignedVector<double> positions = padded_positions(body.points);
  const AlignedVector<double> fewer(positions.begin(), positions.end() - 4);
  std::vector<Contact> contacts;
  EXPECT_THROW(finder.find(fewer, positions, contacts), InvalidArgument);
  EXPECT_THROW(finder.find(positions, fewer, contacts), InvalidArgument);
  EXPECT_THROW((void)finder.penetration(fewer), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
