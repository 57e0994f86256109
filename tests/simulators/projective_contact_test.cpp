// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/contact_rows.hpp"
#include "projective_bodies.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

using test::projective_box;

constexpr double kGravity = 9.81;
constexpr double kSide = 0.2;  // side of the falling boxes

ProjectiveOptions with_floor(const Point& normal = {0, 1, 0}, double friction = 0.0) {
  ProjectiveOptions options;
  options.time_step = 0.004;
  options.gravity = {0, -kGravity, 0};
  options.iterations = 12;
  options.keep_duals = false;
  options.contact.obstacles.push_back({half_space({0, 0, 0}, normal), friction});
  options.contact.reach = 0.02 * kSide;
  options.contact_solver.tolerance = 1e-8;
  options.contact_solver.max_iterations = 2000;
  return options;
}

/// A box that stands on one edge or corner, `height` above the origin.
test::ProjectiveAtRest tilted_box(double about_z, double about_x, double height) {
  test::ProjectiveAtRest result = projective_box({4, 4, 4}, {kSide, kSide, kSide}, LocalModel::neo_hookean);
  double lowest = 1e9;
  for (Point& p : result.points) {
    p = {std::cos(about_z) * p[0] - std::sin(about_z) * p[1],
         std::sin(about_z) * p[0] + std::cos(about_z) * p[1], p[2]};
    p = {p[0], std::cos(about_x) * p[1] - std::sin(about_x) * p[2],
         std::sin(about_x) * p[1] + std::cos(about_x) * p[2]};
    lowest = std::min(lowest, p[1]);
  }
  for (Point& p : result.points) p[1] += height - lowest;
  return result;
}

double mean_height(const MotionState& state) {
  double sum = 0.0;
  for (const Point& p : state.positions) sum += p[1];
  return sum / static_cast<double>(state.positions.size());
}

TEST(ProjectiveContact, AStepThatConvergesEarlyEndsWhereTheOthersDo) {
  const auto [points, body] = tilted_box(0.5, 0.3, 0.001);
  ProjectiveOptions options = with_floor();
  options.iterations = 400;
  ProjectiveDynamics<double> whole(points, body, options);
  options.tolerance = 1e-7;
  ProjectiveDynamics<double> early(points, body, options);
  for (int step = 0; step < 12; ++step) {
    whole.step();
    const StepReport report = early.step();
    ASSERT_LT(report.admm_iterations, options.iterations);
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(early.state().positions[v][c], whole.state().positions[v][c], 1e-4 * kSide)
            << "step " << step;
    }
  }
}

TEST(ProjectiveContact, ABodyBouncesLowerAndLowerAndComesToRest) {
  const auto [points, body] = tilted_box(0.5, 0.3, 0.3);
  ProjectiveDynamics<double> simulator(points, body, with_floor());
  const double start = mean_height(simulator.state());
  const double weight = kGravity * std::accumulate(simulator.masses().begin(), simulator.masses().end(), 0.0);
  double energy = test::total(simulator.balance());
  const double fallen = energy;
  bool touched = false;
  bool left = false;
  for (int step = 0; step < 500; ++step) {
    const StepReport report = simulator.step();
    ASSERT_TRUE(report.warnings.empty()) << report.warnings.front();
    EXPECT_LE(report.penetration, 1e-3 * kSide) << "step " << step;
    touched = touched || report.contacts > 0;
    left = left || (touched && report.contacts == 0);
    EXPECT_LT(mean_height(simulator.state()), start);
    const double now = test::total(simulator.balance());
    EXPECT_LE(now, energy + 1e-4 * fallen) << "step " << step;
    energy = now;
  }
  EXPECT_TRUE(left);
  const Balance rest = simulator.balance();
  // without friction the box keeps sliding
  double rising = 0.0;
  const MotionState end = simulator.state();
  for (std::size_t v = 0; v < points.size(); ++v)
    rising += 0.5 * simulator.masses()[v] * end.velocities[v][1] * end.velocities[v][1];
  EXPECT_LT(rising, 1e-5 * fallen);
  EXPECT_NEAR(rest.potential, weight * kSide / 2, 0.02 * weight * kSide);  // flat on a face
}

TEST(ProjectiveContact, TheFloorCarriesTheWeightAndNeverPulls) {
  const auto [points, body] = projective_box({3, 3, 3}, {kSide, kSide, kSide}, LocalModel::strain);
  ProjectiveDynamics<double> simulator(points, body, with_floor());
  test::run(simulator, 100);
  EXPECT_LT(simulator.balance().kinetic, 1e-4);
  // pulled upward, it leaves the floor with the acceleration of the pull
  ProjectiveOptions up = with_floor();
  up.gravity = {0, 2, 0};
  ProjectiveDynamics<double> pulled(points, body, up);
  MotionState state = simulator.state();
  state.velocities.assign(points.size(), Point{});
  state.positions = points;
  pulled.set_state(state);
  test::run(pulled, 5);
  for (const Point& v : pulled.state().velocities) EXPECT_NEAR(v[1], 5 * 0.004 * 2, 1e-9);
}

TEST(ProjectiveContact, FastBodiesDoNotPassThroughThinWalls) {
  // 10 m/s: 40 mm a step against a wall of 2 mm
  auto [points, body] = projective_box({2, 2, 2}, {0.05, 0.05, 0.05}, LocalModel::neo_hookean);
  for (Point& p : points) p = {p[0] - 0.025, p[1] - 0.025, p[2] - 0.025};
  ProjectiveOptions options = with_floor();
  options.contact.obstacles = {{bowl({0, 0, 0}, {0, 1, 0}, 0.2, 0.002, 1.0), 0.0}};
  options.gravity = {};
  ProjectiveDynamics<double> simulator(points, body, options);
  MotionState state = simulator.state();
  for (Point& v : state.velocities) v = {0, -10, 0};
  simulator.set_state(state);
  for (int step = 0; step < 40; ++step) {
    const StepReport report = simulator.step();
    EXPECT_LE(report.penetration, 1e-3 * 0.05);
    for (const Point& p : simulator.state().positions) EXPECT_LT(std::hypot(p[0], p[1], p[2]), 0.2);
  }
}

TEST(ProjectiveContact, FrictionHoldsABlockOnASlopeThatIsNotTooSteep) {
  const double angle = 0.3;
  const Point normal{std::sin(angle), std::cos(angle), 0};
  for (const double friction : {0.5, 0.1}) {
    auto [points, body] = projective_box({3, 2, 3}, {0.3, 0.1, 0.3}, LocalModel::strain);
    for (Point& p : points) {
      p = {std::cos(angle) * p[0] + std::sin(angle) * p[1], -std::sin(angle) * p[0] + std::cos(angle) * p[1],
           p[2]};
    }
    ProjectiveOptions options = with_floor(normal, friction);
    ProjectiveDynamics<double> simulator(points, body, options);
    for (int step = 0; step < 100; ++step) simulator.step();
    double speed = 0.0;  // downhill
    for (const Point& v : simulator.state().velocities)
      speed += (std::cos(angle) * v[0] - std::sin(angle) * v[1]) / static_cast<double>(points.size());
    const double slides =
        std::max(0.0, kGravity * (std::sin(angle) - friction * std::cos(angle))) * 100 * options.time_step;
    EXPECT_NEAR(speed, slides, 0.03) << friction;
  }
}

/// An open ring whose ends are driven into each other.
test::ProjectiveAtRest open_ring() {
  const int cubes = test::kSanitized ? 2 : 3;  // across the ring
  test::ProjectiveAtRest ring =
      projective_box({40 * cubes / 3, cubes, cubes}, {1.0, 0.1, 0.1}, LocalModel::neo_hookean);
  for (Point& p : ring.points) {
    const double angle = 0.15 + (2 * std::numbers::pi - 0.3) * p[0];
    const double radius = 0.16 + p[1];
    p = {radius * std::cos(angle), -radius * std::sin(angle), p[2]};
  }
  return ring;
}

TEST(ProjectiveContact, TheEndsOfARingMeetAndDoNotPass) {
  const auto [points, body] = open_ring();
  for (const bool with_itself : {true, false}) {
    ProjectiveOptions options = with_floor();
    options.contact.obstacles.clear();
    options.contact.with_itself = with_itself;
    options.gravity = {};
    options.contact_solver.tolerance = 1e-6;
    ProjectiveDynamics<double> simulator(points, body, options);
    MotionState state = simulator.state();
    for (std::size_t v = 0; v < points.size(); ++v) {
      if (points[v][0] > 0.05) state.velocities[v] = {0, points[v][1] > 0 ? -1.5 : 1.5, 0};
    }
    simulator.set_state(state);
    const Point momentum = simulator.balance().momentum;
    ContactOptions look;
    look.with_itself = true;
    ContactFinder finder(body.simplices, points, look);
    std::vector<int> standing(points.size(), 0);
    Index largest = 0;
    int longest = 0;
    double energy = test::total(simulator.balance());
    const double first = energy;
    for (int step = 0; step < 60; ++step) {
      simulator.step();
      const AlignedVector<double> positions = padded_positions(simulator.state().positions);
      std::vector<Contact> inside;
      finder.find(positions, positions, inside);
      largest = std::max(largest, index_size(inside));
      std::vector<char> is_inside(points.size(), 0);
      for (const Contact& contact : inside) {
        // touching corners may be inside by up to 1e-3, 1 % of the ring's thickness
        if (depth<double>(contact, positions) > 1e-3) is_inside[contact.vertices[0]] = 1;
      }
      for (std::size_t v = 0; v < points.size(); ++v) {
        standing[v] = is_inside[v] != 0 ? standing[v] + 1 : 0;
        longest = std::max(longest, standing[v]);
      }
      const double now = test::total(simulator.balance());
      EXPECT_LE(with_itself ? now : 0.0, energy + 1e-3 * first) << "step " << step;
      energy = now;
    }
    if (with_itself) {
      EXPECT_LE(longest, 10);
      EXPECT_LT(energy, first);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(simulator.balance().momentum[c], momentum[c], 1e-6);
    } else {
      EXPECT_GT(largest, 10);  // the test is not trivial
    }
  }
}

TEST(ProjectiveContact, MovesTheSameInEveryOrderAndOnAnyNumberOfThreads) {
  const test::ProjectiveAtRest original = tilted_box(0.4, 0.2, 0.001);
  const std::vector<Index> place = test::shuffled(index_size(original.points), 3).old_to_new();
  const test::ProjectiveAtRest scrambled = test::renumbered(original, place);
  ProjectiveOptions options = with_floor();
  options.contact.with_itself = true;
  options.contact_solver.tolerance = 1e-10;
  std::vector<MotionState> ends;
  for (const std::size_t threads : {1, 2, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    ProjectiveDynamics<double> simulator(original.points, original.body, options);
    Index touching = 0;
    for (int step = 0; step < 15; ++step) touching += simulator.step().contacts;
    EXPECT_GT(touching, 0);
    ends.push_back(simulator.state());
    EXPECT_EQ(ends.back().positions, ends.front().positions) << threads;
  }
  ProjectiveDynamics<double> other(scrambled.points, scrambled.body, options);
  test::run(other, 15);
  test::expect_same(other.state().positions, test::renumbered(ends[0], place).positions, 1e-7);
}

TEST(ProjectiveContact, HeldVerticesStayWhateverTheyTouch) {
  const auto [points, body] = projective_box({3, 3, 3}, {kSide, kSide, kSide}, LocalModel::strain);
  ProjectiveOptions options = with_floor();
  options.contact.with_itself = true;
  // a corner is driven through the floor and drags the body along
  options.prescribed.push_back({{{0}}, {0, -0.2, 0}});
  ProjectiveDynamics<double> simulator(points, body, options);
  for (int step = 0; step < 10; ++step) simulator.step();
  const MotionState state = simulator.state();
  EXPECT_NEAR(state.positions[0][1], -0.008, 1e-12);
  for (std::size_t v = 1; v < points.size(); ++v) EXPECT_GT(state.positions[v][1], -1e-3 * kSide);
}

}  // namespace
}  // namespace meshorder
