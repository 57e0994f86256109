// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/elasticity.hpp"
#include "kernels/springs.hpp"
#include "mesh/graphs.hpp"
#include "projective_bodies.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace meshorder {
namespace {

using test::expect_same;
using test::kLocalLaws;
using test::projective_box;
using test::run;
using testing::HasSubstr;

/// Options for a step of backward Euler that converges to rounding errors.
ProjectiveOptions converged() {
  ProjectiveOptions options;
  options.time_step = 0.02;
  options.iterations = 20000;
  options.tolerance = 1e-13;
  return options;
}

TEST(ProjectiveDynamics, AFreeBodyFallsByTheClosedForm) {
  for (const LocalModel model : kLocalLaws) {
    const auto [points, body] = projective_box({2, 2, 2}, {1, 1, 1}, model);
    ProjectiveOptions options;
    options.gravity = {0, -9.81, 0.5};
    options.iterations = 3;
    ProjectiveDynamics<double> simulator(points, body, options);
    const int n = 20;
    run(simulator, n);
    const MotionState state = simulator.state();
    EXPECT_EQ(state.step, n);
    EXPECT_DOUBLE_EQ(state.time, n * options.time_step);
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (int c = 0; c < 3; ++c) {
        const double h = options.time_step;
        EXPECT_NEAR(state.velocities[v][c], n * h * options.gravity[c], 1e-8);
        EXPECT_NEAR(state.positions[v][c], points[v][c] + h * h * options.gravity[c] * n * (n + 1) / 2, 1e-9);
      }
    }
    EXPECT_NEAR(simulator.balance().elastic, 0.0, 1e-6);
  }
}

TEST(ProjectiveDynamics, KeepsMomentumHoweverFewItsIterations) {
  for (const LocalModel model : kLocalLaws) {
    for (const bool keeps : {true, false}) {
      const auto [points, body] = projective_box({3, 2, 2}, {3, 2, 2}, model);
      ProjectiveOptions options;
      options.iterations = 2;
      options.keep_duals = keeps;
      ProjectiveDynamics<double> simulator(points, body, options);
      simulator.set_state(test::disturbed(points, 0.1));
      const Point before = simulator.balance().momentum;
      run(simulator, 20);
      const Point after = simulator.balance().momentum;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-8 * 12000);
    }
  }
}

TEST(ProjectiveDynamics, ConvergesToTheImplicitMinimiser) {
  for (const auto& [local, law] : {std::pair(LocalModel::neo_hookean, MaterialModel::neo_hookean),
                                   std::pair(LocalModel::stvk, MaterialModel::stvk)}) {
    const auto [points, body] = projective_box({3, 2, 1}, {1, 0.6, 0.5}, local);
    ProjectiveOptions options = converged();
    options.gravity = {0, -9, 0};
    options.prescribed.push_back({{{0, 1}}, {0, 0.1, 0}});
    options.forces.push_back({{{9}}, {40, 0, -30}});
    ProjectiveDynamics<double> projective(points, body, options);

    const auto [same_points, plain] = test::box({3, 2, 1}, {1, 0.6, 0.5}, law);
    ImplicitOptions implicit;
    static_cast<MotionOptions&>(implicit) = options;
    implicit.solve.tolerance = 1e-13;
    implicit.newton_iterations = 50;
    implicit.newton_tolerance = 1e-12;
    BackwardEuler newton(same_points, plain, implicit);

    const MotionState start = test::disturbed(points, 0.02);
    for (Integrator* const integrator :
         {static_cast<Integrator*>(&projective), static_cast<Integrator*>(&newton)}) {
      integrator->set_state(start);
      run(*integrator, 3);
    }
    EXPECT_GT(std::abs(newton.state().positions[9][0] - start.positions[9][0]), 1e-3);
    expect_same(projective.state().positions, newton.state().positions, 1e-9);
    EXPECT_NEAR(projective.balance().elastic, newton.balance().elastic, 1e-6 * newton.balance().elastic);
  }
}

TEST(ProjectiveDynamics, BalancesTheForcesOfSprings) {
  const auto [points, body] = projective_box({3, 2, 2}, {1, 0.6, 0.5}, LocalModel::springs);
  ProjectiveOptions options = converged();
  options.gravity = {0, -9, 0};
  ProjectiveDynamics<double> simulator(points, body, options);
  const MotionState before = test::disturbed(points, 0.03);
  simulator.set_state(before);
  run(simulator, 1);
  const MotionState after = simulator.state();
  Incidence elements{index_size(points), {}, body.simplices.vertices};
  for (Offset s = 0; s <= body.simplices.size(); ++s) elements.offsets.push_back(4 * s);
  const Springs springs = springs_on_edges(joined_vertices(elements), points);
  AlignedVector<double> forces = padded_zeros(index_size(points));
  add_spring_forces(springs, body.law.stiffness, padded_positions(after.positions), forces);
  EXPECT_NEAR(simulator.balance().elastic,
              spring_energy(springs, body.law.stiffness, padded_positions(after.positions)), 1e-9);
  const double h = options.time_step;
  for (std::size_t v = 0; v < points.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      const double pull = forces[4 * v + c] + simulator.masses()[v] * options.gravity[c];
      EXPECT_NEAR(simulator.masses()[v] * (after.velocities[v][c] - before.velocities[v][c]), h * pull, 1e-8);
    }
  }
}

TEST(ProjectiveDynamics, UnfoldsFromOnePoint) {
  const std::array<Index, 3> cubes =
      test::kSanitized ? std::array<Index, 3>{2, 3, 2} : std::array<Index, 3>{4, 5, 3};
  const auto [points, body] = projective_box(cubes, {0.8, 1, 0.6}, LocalModel::strain);
  ProjectiveOptions options;
  options.time_step = 0.04;
  options.iterations = 100;
  ProjectiveDynamics<double> simulator(points, body, options);
  MotionState squashed = simulator.state();
  std::fill(squashed.positions.begin(), squashed.positions.end(), Point{0.4, 0.5, 0.3});
  simulator.set_state(squashed);
  run(simulator, 60);
  // the first steps, which do not converge, rotate the body
  const std::vector<Point> positions = simulator.state().positions;
  const auto distance = [](const std::vector<Point>& at, Index a, Index b) {
    return std::hypot(at[a][0] - at[b][0], at[a][1] - at[b][1], at[a][2] - at[b][2]);
  };
  for (Index v = 0; v < index_size(points); ++v) {
    for (Index other = 0; other < v; ++other)
      EXPECT_NEAR(distance(positions, v, other), distance(points, v, other), 2e-3);
  }
  const AlignedVector<double> padded = padded_positions(positions);
  EXPECT_LT(elastic_energy(rest_shapes(body.simplices, points),
                           {MaterialModel::neo_hookean, Tangent::exact, body.law.lame, {}, {}}, padded),
            1.0);  // a body that is inside out has thousands
}

TEST(ProjectiveDynamics, StretchesSymmetrically) {
  const auto [points, body] = projective_box({5, 3, 3}, {1, 0.6, 0.6}, LocalModel::springs);
  ProjectiveOptions options;
  options.iterations = 5;
  ProjectiveDynamics<double> simulator(points, body, options);
  MotionState start = simulator.state();
  for (std::size_t v = 0; v < points.size(); ++v)
    start.velocities[v] = {points[v][0] >= 0.5 ? 0.5 : -0.5, 0, 0};
  simulator.set_state(start);
  for (int step = 0; step < 5; ++step) {
    run(simulator, 10);
    // the box with its tetrahedra is point-symmetric, and reversed numbers are those of opposite vertices
    const std::vector<Point> positions = simulator.state().positions;
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(positions[v][c] + positions[points.size() - 1 - v][c], points.back()[c], 1e-11);
    }
    for (const double p : simulator.balance().momentum) EXPECT_NEAR(p, 0.0, 1e-9);
  }
  EXPECT_GT(std::abs(simulator.state().positions.back()[0] - 1.0), 1e-3);
}

TEST(ProjectiveDynamics, MovesTheSameInEveryOrder) {
  for (const LocalModel model : kLocalLaws) {
    const test::ProjectiveAtRest original = projective_box({4, 3, 2}, {4, 3, 2}, model);
    const std::vector<Index> place = test::shuffled(index_size(original.points), 5).old_to_new();
    const test::ProjectiveAtRest scrambled = test::renumbered(original, place);
    const MotionState start = test::disturbed(original.points, 0.05);
    ProjectiveOptions options;
    options.gravity = {0, -9.81, 0};
    options.prescribed.push_back({{{7}}, {}});
    options.forces.push_back({{{3}}, {50, 0, 0}});
    ProjectiveDynamics<double> expected(original.points, original.body, options);
    expected.set_state(start);
    run(expected, 10);
    options.prescribed[0].vertices = {place[7]};
    options.forces[0].vertices = {place[3]};
    ProjectiveDynamics<double> actual(scrambled.points, scrambled.body, options);
    actual.set_state(test::renumbered(start, place));
    run(actual, 10);
    expect_same(actual.state().positions, test::renumbered(expected.state(), place).positions, 1e-9);
  }
}

TEST(ProjectiveDynamics, GivesTheSameBitsOnAnyNumberOfThreads) {
  for (const LocalModel model : kLocalLaws) {
    const auto [points, body] = projective_box({12, 12, 12}, {1, 1, 1}, model);
    std::vector<MotionState> ends;
    for (const std::size_t threads : test::kSanitized ? std::vector{1, 3} : std::vector{1, 2, 3}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      ProjectiveOptions options;
      options.gravity = {0, -9.81, 0};
      options.iterations = 4;
      options.tolerance = 1e-6;
      ProjectiveDynamics<double> simulator(points, body, options);
      simulator.set_state(test::disturbed(points, 0.002));
      for (int i = 0; i < 2; ++i) simulator.step();
      ends.push_back(simulator.state());
      EXPECT_EQ(ends.back().positions, ends.front().positions) << threads;
      EXPECT_EQ(ends.back().memory, ends.front().memory) << threads;
    }
  }
}

TEST(ProjectiveDynamics, GoesOnFromAStateBitForBit) {
  for (const bool keeps : {true, false}) {
    const auto [points, body] = projective_box({3, 3, 3}, {1, 1, 1}, LocalModel::strain);
    ProjectiveOptions options;
    options.keep_duals = keeps;
    ProjectiveDynamics<double> whole(points, body, options);
    whole.set_state(test::disturbed(points, 0.05));
    run(whole, 4);
    const MotionState middle = whole.state();
    EXPECT_EQ(middle.memory.empty(), !keeps);
    run(whole, 4);
    ProjectiveDynamics<double> part(points, body, options);
    part.set_state(middle);
    run(part, 4);
    EXPECT_EQ(part.state().positions, whole.state().positions);
    EXPECT_EQ(part.state().velocities, whole.state().velocities);
    EXPECT_EQ(part.state().step, 8);
    // the memory matters
    MotionState forgetful = middle;
    forgetful.memory.clear();
    part.set_state(forgetful);
    run(part, 4);
    EXPECT_EQ(part.state().positions != whole.state().positions, keeps);
  }
}

TEST(ProjectiveDynamics, SinglePrecisionMovesTheBodyTheSameWay) {
  for (const LocalModel model : kLocalLaws) {
    const auto [points, body] = projective_box({3, 3, 3}, {1, 1, 1}, model);
    ProjectiveOptions options;
    ProjectiveDynamics<double> exact(points, body, options);
    ProjectiveDynamics<float> rounded(points, body, options);
    const MotionState start = test::disturbed(points, 0.03);
    exact.set_state(start);
    rounded.set_state(start);
    run(exact, 10);
    run(rounded, 10);
    EXPECT_NE(exact.state().positions, rounded.state().positions);
    expect_same(rounded.state().positions, exact.state().positions, 2e-4);
  }
}

TEST(ProjectiveDynamics, StopsAtItsTolerance) {
  const auto [points, body] = projective_box({3, 3, 3}, {1, 1, 1}, LocalModel::strain);
  ProjectiveOptions options = converged();
  ProjectiveDynamics<double> exact(points, body, options);
  const MotionState start = test::disturbed(points, 0.03);
  exact.set_state(start);
  exact.step();
  double last_error = std::numeric_limits<double>::infinity();
  int last_iterations = 0;
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
    options.tolerance = tolerance;
    ProjectiveDynamics<double> simulator(points, body, options);
    simulator.set_state(start);
    const StepReport report = simulator.step();
    EXPECT_LE(report.residual, tolerance);
    EXPECT_GT(report.residual, 0.0);
    EXPECT_GT(report.admm_iterations, last_iterations);
    last_iterations = report.admm_iterations;
    double error = 0.0;
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (int c = 0; c < 3; ++c)
        error = std::max(error, std::abs(simulator.state().positions[v][c] - exact.state().positions[v][c]));
    }
    EXPECT_LT(error, last_error);
    last_error = error;
  }
  EXPECT_LT(last_error, 1e-7);
}

TEST(ProjectiveDynamics, ItsResidualIsNoLessThanWhatElementsLeave) {
  const auto [points, body] = projective_box({3, 3, 3}, {1, 1, 1}, LocalModel::strain);
  const MotionState start = test::disturbed(points, 0.03);
  int equal = 0;
  for (int iterations = 2; iterations < 12; ++iterations) {
    ProjectiveOptions options;
    options.tolerance = 1e-30;
    options.iterations = iterations - 1;
    ProjectiveDynamics<double> before(points, body, options);
    before.set_state(start);
    before.step();
    // the local steps at the start of the next iteration
    LocalSteps<double> local(body.law, body.simplices, points);
    local.set_duals(before.state().memory);
    AlignedVector<double> forces(4 * local.room());
    const LocalResidual left = local.pass(padded_positions(before.state().positions), 1.0, forces);
    const double primal = std::sqrt(left.primal / left.magnitude);
    options.iterations = iterations;
    ProjectiveDynamics<double> after(points, body, options);
    after.set_state(start);
    const double residual = after.step().residual;
    EXPECT_GE(residual, primal * (1 - 1e-12)) << iterations;
    equal += residual <= primal * (1 + 1e-12) ? 1 : 0;
  }
  EXPECT_GT(equal, 0);   // the primal residual is the larger one in some cases …
  EXPECT_LT(equal, 10);  // … but not in all
}

TEST(ProjectiveDynamics, PrescribedVerticesMoveAsPrescribed) {
  const auto [points, body] = projective_box({3, 1, 1}, {1, 0.5, 0.5}, LocalModel::neo_hookean);
  ProjectiveOptions options;
  options.gravity = {0, -9.81, 0};
  options.prescribed.push_back({{{0, 1}}, {}});
  // one more vertex is prescribed from the third step on: the matrix is factored anew
  options.prescribed.push_back({{{2}, 2 * options.time_step}, {1, 0, 0}});
  ProjectiveDynamics<double> simulator(points, body, options);
  run(simulator, 2);
  const Point second = simulator.state().positions[2];
  run(simulator, 3);
  const MotionState state = simulator.state();
  EXPECT_EQ(state.positions[0], points[0]);
  EXPECT_EQ(state.positions[1], points[1]);
  EXPECT_EQ(state.velocities[2], (Point{1, 0, 0}));
  EXPECT_NEAR(state.positions[2][0], second[0] + 3 * options.time_step, 1e-12);
  EXPECT_NEAR(state.positions[2][1], second[1], 1e-12);
  EXPECT_NE(state.positions[5], points[5]);
}

TEST(ProjectiveDynamics, VerticesOfNoElementStay) {
  auto [points, body] = projective_box({1, 1, 1}, {1, 1, 1}, LocalModel::strain);
  points.push_back({5, 5, 5});
  ProjectiveOptions options;
  options.gravity = {0, -9.81, 0};
  ProjectiveDynamics<double> simulator(points, body, options);
  run(simulator, 3);
  EXPECT_EQ(simulator.state().positions.back(), points.back());
  EXPECT_EQ(simulator.state().velocities.back(), Point{});
  EXPECT_LT(simulator.state().positions.front()[1], 0.0);
}

TEST(ProjectiveDynamics, AMotionThatIsNotFiniteIsAnErrorAndChangesNothing) {
  const auto [points, body] = projective_box({2, 2, 2}, {1, 1, 1}, LocalModel::strain);
  ProjectiveOptions options;
  options.time_step = 100;
  ProjectiveDynamics<double> simulator(points, body, options);
  run(simulator, 1);
  MotionState state = simulator.state();
  state.velocities[3] = {1e308, 0, -1e308};
  simulator.set_state(state);
  try {
    simulator.step();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("step 2: "));
    EXPECT_THAT(error.what(), HasSubstr("vertex "));
  }
  EXPECT_EQ(simulator.state().positions, state.positions);
  EXPECT_EQ(simulator.state().step, 1);
  // the duals are finite, too
  state = simulator.state();
  state.velocities[3] = {};
  simulator.set_state(state);
  run(simulator, 2);
}

TEST(ProjectiveDynamics, RefusesWhatMakesNoSense) {
  const auto [points, body] = projective_box({1, 1, 1}, {1, 1, 1}, LocalModel::strain);
  const auto refuses = [&, &points = points, &body = body](const ProjectiveOptions& options,
                                                           const char* word) {
    try {
      const ProjectiveDynamics<double> simulator(points, body, options);
      FAIL() << word;
    } catch (const InvalidArgument& error) {
      EXPECT_THAT(error.what(), HasSubstr(word));
    }
  };
  ProjectiveOptions options;
  options.time_step = -1;
  refuses(options, "time step");
  options = {};
  options.iterations = 0;
  refuses(options, "iterations");
  options = {};
  options.tolerance = 1;
  refuses(options, "tolerance");
  options = {};
  options.forces.push_back({{{8}}, {}});
  refuses(options, "vertex");

  ProjectiveBody surface = body;
  surface.simplices.dimension = 2;
  surface.simplices.vertices = {0, 1, 2};
  EXPECT_THROW(ProjectiveDynamics<double>(points, surface, {}), InvalidArgument);
  ProjectiveBody soft = body;
  soft.law.stiffness = 0;
  EXPECT_THROW(ProjectiveDynamics<double>(points, soft, {}), InvalidArgument);

  ProjectiveDynamics<double> simulator(points, body, {});
  run(simulator, 1);
  MotionState state = simulator.state();
  state.memory.pop_back();
  EXPECT_THROW(simulator.set_state(state), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
