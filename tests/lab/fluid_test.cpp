// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/fluid/fluid.hpp"

#include "base/random.hpp"
#include "lab/support/process.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace meshorder {
namespace {

class FluidTest : public testing::Test {
 protected:
  void SetUp() override {
    if (find_program("meshorder-delaunay").empty()) GTEST_SKIP() << "meshorder-delaunay is not built";
  }
};
using FluidOrderTest = FluidTest;
using TriangulationTest = FluidTest;
using AlphaShapeTest = FluidTest;
using ScalarSystemTest = FluidTest;

/// Water of unit height and length that fills the length of the basin, in units in which gravity is 1.
FluidOptions water(double spacing, double width) {
  FluidOptions options;
  options.basin = {1, 3, width};
  options.column = {1, 1, width};
  options.spacing = spacing;
  options.time_step = 1;
  options.gravity = {0, -1, 0};
  return options;
}

/// A column of Martin and Moyce, twice as high as long, in a longer basin.
FluidOptions dam(double spacing, double width) {
  FluidOptions options = water(spacing, width);
  options.basin = {5, 4, width};
  options.column = {1, 2, width};
  return options;
}

double fastest(const MotionState& state) {
  double most = 0;
  for (const Point& u : state.velocities) most = std::max(most, norm(u));
  return most;
}

/// The position of the front, and the height of the water at the wall behind.
std::pair<double, double> front_and_height(const Fluid& fluid, double spacing) {
  const MotionState state = fluid.state();
  double front = 0;
  double height = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (fluid.mesh().alone[i] != 0) continue;
    const Point& x = state.positions[static_cast<std::size_t>(fluid.numbers()[i])];
    front = std::max(front, x[0]);
    if (x[0] < 2 * spacing) height = std::max(height, x[1]);
  }
  return {front, height};
}

/// The value at x, interpolated between two samples.
double at(const std::vector<std::pair<double, double>>& curve, double x) {
  const auto after = std::ranges::lower_bound(curve, x, {}, &std::pair<double, double>::first);
  const auto& [x1, y1] = *after;
  const auto& [x0, y0] = *(after - 1);
  return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

TEST_F(TriangulationTest, spheres_around_tetrahedra_are_empty_and_fill_the_box) {
  std::vector<Point> points;
  for (int i = 0; i < 8; ++i) points.push_back({1.0 * (i & 1), 1.0 * (i >> 1 & 1), 1.0 * (i >> 2)});
  Random random(3);
  for (int i = 0; i < 60; ++i) points.push_back({random.unit(), random.unit(), random.unit()});
  const Triangulation result = delaunay_program()(points);
  double volume = 0;
  for (std::size_t t = 0; t < result.corners.size(); ++t) {
    const auto& [a, b, c, d] = result.corners[t];
    const Point u = minus(points[b], points[a]);
    const Point v = minus(points[c], points[a]);
    const Point w = minus(points[d], points[a]);
    const double six = dot(u, cross(v, w));
    EXPECT_GE(six, 0);
    volume += six / 6;
    Point centre{};
    for (const auto& [edge, normal] :
         {std::pair(u, cross(v, w)), std::pair(v, cross(w, u)), std::pair(w, cross(u, v))})
      centre = plus_scaled(centre, dot(edge, edge) / (2 * six), normal);
    for (const Point& x : points)
      EXPECT_GE(norm(minus(minus(x, points[a]), centre)), norm(centre) * (1 - 1e-9));
    for (int face = 0; face < 4; ++face) {
      const Index beyond = result.neighbours[t][face];
      if (beyond < 0) continue;
      EXPECT_EQ(std::ranges::count(result.neighbours[beyond], static_cast<Index>(t)), 1);
      for (int corner = 0; corner < 4; ++corner)
        EXPECT_EQ(std::ranges::count(result.corners[beyond], result.corners[t][corner]), corner != face);
    }
  }
  EXPECT_NEAR(volume, 1, 1e-12);
}

TEST_F(TriangulationTest, few_equal_and_flat_points_have_no_tetrahedra) {
  const Triangulate triangulate = delaunay_program();
  EXPECT_TRUE(triangulate({}).corners.empty());
  EXPECT_TRUE(triangulate(std::vector<Point>(3)).corners.empty());
  EXPECT_TRUE(triangulate(std::vector<Point>(9, Point{1, 2, 3})).corners.empty());
  const std::vector<Point> flat{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 5, 1}};
  EXPECT_TRUE(triangulate(flat).corners.empty());
  std::vector<Point> solid = flat;
  solid.push_back({0, 0, 2});
  solid.push_back(solid.front());
  EXPECT_FALSE(triangulate(solid).corners.empty());
}

TEST_F(AlphaShapeTest, outer_faces_enclose_the_volume) {
  const FluidOptions options = dam(0.25, 0.5);
  const Particles particles = particles_at_start(options);
  const FluidMesh mesh = alpha_shape(delaunay_program()(particles.positions), particles.positions,
                                     particles.walls, options.spacing);
  double volume = 0;
  for (const auto& [a, b, c] : outer_faces(mesh))
    volume += dot(particles.positions[a], cross(particles.positions[b], particles.positions[c])) / 6;
  EXPECT_NEAR(volume, 1, 0.02);
  for (std::size_t i = 0; i < particles.positions.size(); ++i) {
    const Point& x = particles.positions[i];
    EXPECT_EQ(mesh.free[i], x[1] == 2 || x[0] == 1) << i;
    EXPECT_EQ(mesh.alone[i], 0);
  }
}

/// Returns the error of −Δp = f for p = sin πx sin πy sin πz, in the norm of L².
double error_of_poisson(double spacing) {
  FluidOptions options = water(spacing, 1);
  const Particles particles = particles_at_start(options);
  FluidMesh mesh =
      alpha_shape(delaunay_program()(particles.positions), particles.positions, particles.walls, spacing);
  const ScalarSystem system = assemble(mesh, particles.positions);
  const auto sine = [](double x) { return std::sin(std::numbers::pi * x); };
  const std::size_t n = particles.positions.size();
  std::vector<double> exact(n);
  std::vector<double> b(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& [x, y, z] = particles.positions[i];
    exact[i] = sine(x) * sine(y) * sine(z);
    b[i] = 3 * std::numbers::pi * std::numbers::pi * exact[i] * system.masses[i];
    mesh.free[i] = particles.walls[i] != kNoWalls || y == 1 ? 1 : 0;
  }
  std::vector<double> p(n, 0);
  solve(system, 1, 0, mesh.free, b, p, {.tolerance = 1e-10, .max_iterations = 1000});
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) squares += system.masses[i] * std::pow(p[i] - exact[i], 2);
  return std::sqrt(squares);
}

TEST_F(ScalarSystemTest, pressures_converge_with_order_two) {
  EXPECT_GE(std::log2(error_of_poisson(1.0 / 8) / error_of_poisson(1.0 / 16)), 1.8);
}

TEST_F(FluidTest, still_water_stays_still) {
  FluidOptions options = water(0.1, 0.5);
  options.evening = 0;
  options.volume_gain = 0;
  options.solve.tolerance = 1e-12;
  Fluid fluid(options, {}, delaunay_program());
  for (int step = 0; step < 100; ++step) fluid.step();
  EXPECT_LE(fastest(fluid.state()), 1e-9);
}

TEST_F(FluidTest, falls_freely) {
  FluidOptions options = water(0.2, 0.4);
  options.evening = 0;
  Particles particles = particles_at_start(options);
  for (Point& x : particles.positions) x = plus_scaled(x, 1, {0.1, 1, 0.1});
  options.basin = {2, 9, 2};
  std::ranges::fill(particles.walls, kNoWalls);
  const std::vector<Point> start = particles.positions;
  Fluid fluid(options, std::move(particles), {}, delaunay_program());
  while (fluid.state().time < 1) fluid.step();
  const MotionState state = fluid.state();
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Point expected = plus_scaled(start[i], state.time * state.time / 2, options.gravity);
    EXPECT_LE(norm(minus(state.positions[i], expected)), 1e-12);
  }
}

TEST_F(FluidTest, sloshes_with_the_period_of_its_wave) {
  constexpr double kPi = std::numbers::pi;
  FluidOptions options = water(1.0 / 20, 0.25);
  options.wave = 0.02;
  options.viscosity = 3e-4;
  Fluid fluid(options, {}, delaunay_program());
  const double period = 2 * kPi / std::sqrt(kPi * std::tanh(kPi));
  const double volume = fluid.volume();
  double last_height = options.wave;
  double last_time = 0;
  std::vector<double> zeros;  // times at which the wave's height is 0
  while (zeros.size() < 10) {
    fluid.step();
    const MotionState state = fluid.state();
    double height = 0;
    double weight = 0;
    for (std::size_t i = 0; i < fluid.mesh().free.size(); ++i) {
      if (fluid.mesh().free[i] == 0) continue;
      const Point& x = state.positions[static_cast<std::size_t>(fluid.numbers()[i])];
      height += (x[1] - 1) * std::cos(kPi * x[0]);
      weight += std::pow(std::cos(kPi * x[0]), 2);
    }
    height /= weight;
    if (height * last_height < 0)
      zeros.push_back(last_time + (state.time - last_time) * last_height / (last_height - height));
    last_height = height;
    last_time = state.time;
    EXPECT_NEAR(fluid.volume(), volume, 0.005 * volume);
    ASSERT_LT(state.time, 6 * period);
  }
  EXPECT_NEAR((zeros.back() - zeros.front()) / 4.5, period, 0.02 * period);
}

/// Martin and Moyce (1952), a column twice as high as long: heights at the wall in units of the first height
/// by t √(g / a), table 6, and fronts in units of a by t √(2 g / a), table 2. Here the front reaches the wall
/// of the basin at 2.6.
TEST_F(FluidTest, a_dam_breaks_as_measured) {
  const double spacing = 1.0 / 24;
  Fluid fluid(dam(spacing, 2.0 / 24), {}, delaunay_program());
  std::vector<std::pair<double, double>> heights{{0, 2}};
  std::vector<std::pair<double, double>> fronts{{0, 1}};
  while (heights.back().first < 2.5) {
    fluid.step();
    const auto [front, height] = front_and_height(fluid, spacing);
    heights.emplace_back(fluid.state().time, height);
    fronts.emplace_back(fluid.state().time * std::sqrt(2.0), front);
  }
  for (const auto& [time, height] :
       {std::pair(0.56, 0.94), std::pair(0.77, 0.89), std::pair(0.93, 0.83), std::pair(1.08, 0.78),
        std::pair(1.28, 0.72), std::pair(1.46, 0.67), std::pair(1.66, 0.61), std::pair(1.84, 0.56)})
    EXPECT_NEAR(at(heights, time) / 2, height, 0.02) << time;
  // then the simulated column falls more slowly
  for (const auto& [time, height] : {std::pair(2.0, 0.5), std::pair(2.21, 0.44), std::pair(2.45, 0.39)})
    EXPECT_NEAR(at(heights, time) / 2, height + 0.03, 0.02) << time;
  const double measured = (3.89 - 1.67) / (3.11 - 1.43);
  EXPECT_NEAR((at(fronts, 3.11) - at(fronts, 1.43)) / (3.11 - 1.43), measured, 0.05 * measured);
}

/// Taylor and Green's vortex in a closed box loses the share 1 − exp(−4νπ²t) of its energy to viscosity.
TEST_F(FluidTest, a_vortex_decays_by_viscosity) {
  constexpr double kPi = std::numbers::pi;
  FluidOptions options = water(1.0 / 16, 0.125);
  options.basin = {1, 1, 0.125};
  options.lid = true;
  options.gravity = {};
  options.time_step = 0.02;
  options.viscosity = 0.05;
  Fluid fluid(options, {}, delaunay_program());
  MotionState state = fluid.state();
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const auto& [x, y, z] = state.positions[i];
    state.velocities[i] = {std::sin(kPi * x) * std::cos(kPi * y), -std::cos(kPi * x) * std::sin(kPi * y), 0};
  }
  fluid.set_state(state);
  const double before = fluid.balance().kinetic;
  while (fluid.state().time < 0.3) fluid.step();
  const double decay = std::exp(-4 * options.viscosity * kPi * kPi * fluid.state().time);
  EXPECT_NEAR(fluid.balance().kinetic / before, decay, 0.02 * decay);
}

TEST_F(FluidTest, goes_on_in_single_points) {
  FluidOptions options = water(0.25, 0.5);
  options.basin = {9, 9, 9};
  Particles particles;
  for (int i = 0; i < 8; ++i)
    particles.positions.push_back({1.0 * (i & 1), 4.0 + (i >> 1 & 1), 1.0 * (i >> 2)});
  particles.positions.push_back(particles.positions.front());
  particles.walls.assign(particles.positions.size(), kNoWalls);
  Fluid fluid(options, std::move(particles), {}, delaunay_program());
  for (int step = 0; step < 40; ++step) fluid.step();
  EXPECT_EQ(fluid.mesh().corners.size(), 0U);
  for (const Point& x : fluid.state().positions) EXPECT_LT(x[1], 4);
}

TEST_F(FluidOrderTest, the_flow_is_the_same_in_every_order) {
  const FluidOptions options = dam(0.1, 0.3);
  std::vector<double> fronts;
  for (const FluidOrdering& ordering :
       {FluidOrdering{.vertices = "original", .elements = "original"},
        FluidOrdering{.vertices = "scrambled", .elements = "scrambled"}, FluidOrdering{.vertices = "hilbert"},
        FluidOrdering{.vertices = "fiedler"}, FluidOrdering{.vertices = "rcm", .every = 3},
        FluidOrdering{.vertices = "fiedler", .elements = "fiedler", .every = 1}}) {
    Fluid fluid(options, ordering, delaunay_program());
    for (int step = 0; step < 20; ++step) fluid.step();
    fronts.push_back(front_and_height(fluid, options.spacing).first);
    EXPECT_EQ(std::ranges::is_sorted(fluid.numbers()), ordering.vertices == "original");
  }
  for (const double front : fronts) EXPECT_NEAR(front, fronts.front(), 1e-6);
}

TEST_F(FluidOrderTest, states_continue_on_any_number_of_threads_to_the_bit) {
  const FluidOptions options = dam(0.1, 0.3);
  const auto run = [&](std::size_t threads, const MotionState* from, int steps) {
    const oneapi::tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Fluid fluid(options, {}, delaunay_program());
    if (from != nullptr) fluid.set_state(*from);
    for (int step = 0; step < steps; ++step) fluid.step();
    return fluid.state();
  };
  const MotionState whole = run(1, nullptr, 30);
  const MotionState half = run(2, nullptr, 14);
  const MotionState continued = run(2, &half, 16);
  EXPECT_EQ(continued.positions, whole.positions);
  EXPECT_EQ(continued.velocities, whole.velocities);
  const std::size_t n = whole.positions.size();  // 3 n + 1 numbers, then seconds that orders cost
  EXPECT_TRUE(std::equal(whole.memory.begin(), whole.memory.begin() + 3 * n + 1, continued.memory.begin()));
  EXPECT_EQ(continued.time, whole.time);
}

TEST_F(FluidTest, refuses_states_of_another_fluid) {
  Fluid fluid(dam(0.25, 0.5), {}, delaunay_program());
  const MotionState good = fluid.state();
  MotionState bad = good;
  bad.positions.pop_back();
  EXPECT_THROW(fluid.set_state(bad), InvalidArgument);
  bad = good;
  bad.memory.resize(3);
  EXPECT_THROW(fluid.set_state(bad), InvalidArgument);
  bad = good;
  bad.memory[2 * good.positions.size()] = 1;  // two particles at one place
  EXPECT_THROW(fluid.set_state(bad), InvalidArgument);
  bad.memory[2 * good.positions.size()] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fluid.set_state(bad), InvalidArgument);
  EXPECT_EQ(fluid.state().memory, good.memory);
}

TEST(FluidOptions, out_of_range_are_refused_by_name) {
  const auto message = [](auto change) {
    FluidOptions options = dam(0.25, 0.5);
    change(options);
    try {
      check_options(options);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message([](FluidOptions&) {}), "");
  for (const double bad : {0.0, -1.0, kNan}) {
    EXPECT_NE(message([&](FluidOptions& o) { o.spacing = bad; }).find("spacing"), std::string::npos) << bad;
    EXPECT_NE(message([&](FluidOptions& o) { o.basin[2] = bad; }).find("basin"), std::string::npos) << bad;
    EXPECT_NE(message([&](FluidOptions& o) { o.column[1] = bad; }).find("column"), std::string::npos) << bad;
    EXPECT_NE(message([&](FluidOptions& o) { o.courant = bad; }).find("courant"), std::string::npos) << bad;
    EXPECT_NE(message([&](FluidOptions& o) { o.time_step = bad; }).find("time step"), std::string::npos)
        << bad;
  }
  EXPECT_NE(message([](FluidOptions& o) { o.spacing = 1e-5; }).find("particles"), std::string::npos);
  EXPECT_NE(message([](FluidOptions& o) { o.column[0] = 6; }).find("column"), std::string::npos);
  EXPECT_NE(message([](FluidOptions& o) { o.viscosity = kNan; }).find("viscosity"), std::string::npos);
}

}  // namespace
}  // namespace meshorder
