// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/implicit/backward_euler.hpp"

#include "bodies.hpp"
#include "kernels/positions.hpp"
#include "support/sample_graphs.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

using test::box;
using test::disturbed;
using test::flat;
using testing::HasSubstr;

constexpr std::array kModels{MaterialModel::corotational, MaterialModel::stvk, MaterialModel::neo_hookean};

ImplicitOptions tight() {
  ImplicitOptions options;
  options.solve.tolerance = 1e-13;
  return options;
}

void run(BackwardEuler& simulator, int steps) {
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulator.step();
    ASSERT_TRUE(report.warnings.empty()) << report.warnings.front();
  }
}

double total(const Balance& balance) { return balance.kinetic + balance.elastic + balance.potential; }

TEST(BackwardEuler, AFreeBodyFallsByTheClosedForm) {
  for (const MaterialModel model : kModels) {
    const auto [points, body] = box({2, 2, 2}, {1, 1, 1}, model);
    ImplicitOptions options = tight();
    options.gravity = {0, -9.81, 0.5};
    BackwardEuler simulator(points, body, options);
    const int n = 20;
    run(simulator, n);
    const MotionState state = simulator.state();
    EXPECT_EQ(state.step, n);
    EXPECT_DOUBLE_EQ(state.time, n * options.time_step);
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (int c = 0; c < 3; ++c) {
        // v_k = k h g and x_k = x_{k-1} + h v_k
        const double h = options.time_step;
        EXPECT_NEAR(state.velocities[v][c], n * h * options.gravity[c], 1e-9);
        EXPECT_NEAR(state.positions[v][c], points[v][c] + h * h * options.gravity[c] * n * (n + 1) / 2, 1e-9);
      }
    }
  }
}

TEST(BackwardEuler, MassDampingSlowsAFallByTheClosedForm) {
  const auto [points, body] = box({2, 1, 1}, {1, 1, 1}, MaterialModel::corotational);
  ImplicitOptions options = tight();
  options.gravity = {1, 0, 0};
  options.mass_damping = 3;
  BackwardEuler simulator(points, body, options);
  double velocity = 0;
  for (int i = 0; i < 10; ++i) {
    run(simulator, 1);
    velocity = (velocity + options.time_step) / (1 + 3 * options.time_step);
    EXPECT_NEAR(simulator.state().velocities[3][0], velocity, 1e-12);
  }
}

TEST(BackwardEuler, KeepsMomentumWithoutExternalForces) {
  for (const MaterialModel model : kModels) {
    for (const Mass mass : {Mass::lumped, Mass::consistent}) {
      const auto [points, body] = box({3, 2, 2}, {3, 2, 2}, model);
      ImplicitOptions options = tight();
      options.mass = mass;
      options.stiffness_damping = 0.001;
      BackwardEuler simulator(points, body, options);
      simulator.set_state(disturbed(points, 0.05));
      const Point before = simulator.balance().momentum;
      run(simulator, 10);
      const Point after = simulator.balance().momentum;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-9 * 12 * test::kDensity);
    }
  }
}

/// The mass matrix by its definition.
Eigen::MatrixXd dense_mass(const Body& body, const RestShapes& rest, Index n, Mass kind) {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Offset s = 0; s < body.simplices.size(); ++s) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const double share = kind == Mass::lumped ? (a == b ? 0.25 : 0.0) : (a == b ? 0.1 : 0.05);
        mass.block<3, 3>(3 * body.simplices.vertices[4 * s + a], 3 * body.simplices.vertices[4 * s + b]) +=
            share * body.densities[0] * rest.volume(s) * Eigen::Matrix3d::Identity();
      }
    }
  }
  return mass;
}

/// f_int and K by finite differences of the energy's gradient, which the tests of materials verify.
struct DenseElasticity {
  Eigen::VectorXd forces;
  Eigen::MatrixXd stiffness;

  DenseElasticity(const RestShapes& rest, const Elasticity& elasticity, const std::vector<Point>& positions) {
    const auto n = static_cast<Eigen::Index>(positions.size());
    const auto internal = [&](const Eigen::VectorXd& x) {
      std::vector<Point> at(positions.size());
      for (Eigen::Index i = 0; i < 3 * n; ++i) at[i / 3][i % 3] = x(i);
      AlignedVector<double> f = padded_zeros(static_cast<Index>(n));
      add_elasticity(rest, elasticity, padded_positions(at), f, nullptr);
      Eigen::VectorXd result(3 * n);
      for (Eigen::Index i = 0; i < 3 * n; ++i) result(i) = -f[i / 3 * kPaddedStride + i % 3];
      return result;
    };
    const Eigen::VectorXd x = flat(positions);
    forces = internal(x);
    stiffness.resize(3 * n, 3 * n);
    constexpr double kStep = 1e-6;
    for (Eigen::Index j = 0; j < 3 * n; ++j) {
      const Eigen::VectorXd e = kStep * Eigen::VectorXd::Unit(3 * n, j);
      stiffness.col(j) = (internal(x + e) - internal(x - e)) / (2 * kStep);
    }
  }
};

TEST(BackwardEuler, OneStepSolvesTheLinearisedEquation) {
  for (const MaterialModel model : kModels) {
    for (const Mass mass : {Mass::lumped, Mass::consistent}) {
      const auto [points, body] = box({2, 1, 1}, {1, 0.6, 0.5}, model);
      ImplicitOptions options = tight();
      options.mass = mass;
      options.mass_damping = 0.7;
      options.stiffness_damping = 0.02;
      options.gravity = {0, -3, 1};
      options.forces.push_back({{{2, 5}}, {4, 1, -2}});
      BackwardEuler simulator(points, body, options);
      const MotionState before = disturbed(points, 0.01);
      simulator.set_state(before);
      run(simulator, 1);

      const Index n = index_size(points);
      const RestShapes rest = rest_shapes(body.simplices, points);
      const Eigen::MatrixXd m = dense_mass(body, rest, n, mass);
      const DenseElasticity elastic(rest, body.elasticity, before.positions);
      const double h = options.time_step;
      const Eigen::MatrixXd damping = 0.7 * m + 0.02 * elastic.stiffness;
      const Eigen::VectorXd v = flat(before.velocities);
      Eigen::VectorXd loads(3 * n);
      for (Index i = 0; i < n; ++i) {
        loads.segment<3>(3 * i) = m.row(3 * i).sum() * Eigen::Vector3d(0, -3, 1);
        if (i == 2 || i == 5) loads.segment<3>(3 * i) += Eigen::Vector3d(4, 1, -2);
      }
      const Eigen::VectorXd change =
          (m + h * damping + h * h * elastic.stiffness)
              .ldlt()
              .solve(h * (loads - elastic.forces - h * elastic.stiffness * v - damping * v));
      const MotionState after = simulator.state();
      EXPECT_LT((flat(after.velocities) - v - change).norm(), 1e-7 * change.norm());
      EXPECT_LT((flat(after.positions) - flat(before.positions) - h * (v + change)).norm(), 1e-9);
    }
  }
}

TEST(BackwardEuler, NewtonSolvesTheNonlinearEquation) {
  for (const MaterialModel model : kModels) {
    const auto [points, body] = box({2, 1, 1}, {1, 0.6, 0.5}, model);
    ImplicitOptions options = tight();
    options.time_step = 0.05;
    options.mass_damping = 0.5;
    options.stiffness_damping = 0.01;
    options.gravity = {0, -9, 0};
    options.newton_iterations = 30;
    options.newton_tolerance = 1e-11;
    options.prescribed.push_back({{{0, 1}}, {0, 0.1, 0}});
    BackwardEuler simulator(points, body, options);
    MotionState before = disturbed(points, 0.03);
    simulator.set_state(before);
    const StepReport report = simulator.step();
    EXPECT_LT(report.newton_residual, 1e-11);
    EXPECT_GT(report.newton_iterations, 1);
    EXPECT_LT(report.newton_iterations, 12);

    const Index n = index_size(points);
    const RestShapes rest = rest_shapes(body.simplices, points);
    const Eigen::MatrixXd m = dense_mass(body, rest, n, Mass::lumped);
    const MotionState after = simulator.state();
    const double h = options.time_step;
    // C has the stiffness at the start of the step, but with the held vertices moved
    std::vector<Point> start = before.positions;
    for (const Index v : {0, 1}) start[v][1] += h * 0.1;
    const Eigen::MatrixXd damping = 0.5 * m + 0.01 * DenseElasticity(rest, body.elasticity, start).stiffness;
    const DenseElasticity elastic(rest, body.elasticity, after.positions);
    const Eigen::VectorXd v = flat(after.velocities);
    Eigen::VectorXd gravity = Eigen::VectorXd::Zero(3 * n);
    for (Index i = 0; i < n; ++i) gravity(3 * i + 1) = -9 * m(3 * i, 3 * i);
    Eigen::VectorXd g = m * (v - flat(before.velocities)) - h * (gravity - elastic.forces) + h * damping * v;
    const double scale = (m * v).norm();
    g.head<6>().setZero();
    EXPECT_LT(g.norm(), 1e-6 * scale);  // the stiffness here is by finite differences
    for (const Index held : {0, 1}) EXPECT_DOUBLE_EQ(after.velocities[held][1], 0.1);
  }
}

TEST(BackwardEuler, ConvergesAtFirstOrderInTheTimeStep) {
  const auto [points, body] = box({3, 1, 1}, {1, 0.3, 0.3}, MaterialModel::corotational);
  const auto end = [&, &points = points, &body = body](int steps) {
    ImplicitOptions options = tight();
    options.time_step = 0.02 / steps;
    options.gravity = {0, -9.81, 0};
    options.prescribed.push_back({{{0, 1, 2, 3}}, {}});
    BackwardEuler simulator(points, body, options);
    run(simulator, steps);
    return flat(simulator.state().positions);
  };
  const Eigen::VectorXd fine = end(2048);
  const double coarse_error = (end(16) - fine).norm();
  const double halved = (end(32) - fine).norm();
  EXPECT_NEAR(coarse_error / halved, 2.0, 0.25);
}

TEST(BackwardEuler, EnergyNeverGrowsWithoutWork) {
  for (const MaterialModel model : kModels) {
    const auto [points, body] = box({3, 2, 2}, {3, 2, 2}, model);
    ImplicitOptions options = tight();
    options.newton_iterations = 40;
    options.newton_tolerance = 1e-10;
    BackwardEuler simulator(points, body, options);
    simulator.set_state(disturbed(points, 0.1));
    double energy = total(simulator.balance());
    for (int i = 0; i < 40; ++i) {
      run(simulator, 1);
      const double now = total(simulator.balance());
      EXPECT_LE(now, energy * (1 + 1e-9)) << "step " << i;
      energy = now;
    }
  }
}

TEST(BackwardEuler, TheBalanceOfARigidMotionIsTheClosedForm) {
  for (const Mass kind : {Mass::lumped, Mass::consistent}) {
    const auto [points, body] = box({3, 2, 2}, {3, 2, 1}, MaterialModel::neo_hookean);
    ImplicitOptions options;
    options.mass = kind;
    options.gravity = {1, -9, 2};
    BackwardEuler simulator(points, body, options);
    const Eigen::Vector3d velocity(0.3, -0.2, 0.5);
    const Eigen::Vector3d spin(0.4, 0.1, -0.7);
    MotionState state = simulator.state();
    for (std::size_t v = 0; v < points.size(); ++v) {
      Eigen::Map<Eigen::Vector3d>(state.velocities[v].data()) =
          velocity + spin.cross(Eigen::Map<const Eigen::Vector3d>(points[v].data()));
    }
    simulator.set_state(state);

    const RestShapes rest = rest_shapes(body.simplices, points);
    const Eigen::MatrixXd mass = dense_mass(body, rest, index_size(points), kind);
    const Eigen::VectorXd v = flat(state.velocities);
    const Eigen::VectorXd p = mass * v;
    const Balance balance = simulator.balance();
    EXPECT_NEAR(balance.kinetic, 0.5 * v.dot(p), 1e-9 * v.dot(p));
    EXPECT_NEAR(balance.elastic, 0.0, 1e-9);
    // 6 m³ about the centre (1.5, 1, 0.5)
    EXPECT_NEAR(balance.potential, -6 * test::kDensity * (1.5 * 1 - 1 * 9 + 0.5 * 2), 1e-6);
    const Eigen::Vector3d centre(1.5, 1, 0.5);
    const Eigen::Vector3d momentum = 6 * test::kDensity * (velocity + spin.cross(centre));
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      angular += Eigen::Map<const Eigen::Vector3d>(points[i].data())
                     .cross(p.segment<3>(static_cast<Eigen::Index>(3 * i)));
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(balance.momentum[c], momentum(c), 1e-8 * momentum.norm());
      EXPECT_NEAR(balance.angular_momentum[c], angular(c), 1e-9 * angular.norm());
    }
  }
}

TEST(BackwardEuler, RestStaysRest) {
  for (const MaterialModel model : kModels) {
    const auto [points, body] = box({2, 2, 1}, {1, 1, 1}, model);
    BackwardEuler simulator(points, body, {});
    run(simulator, 3);
    // rounding of the rest shapes is the only force
    EXPECT_LT((flat(simulator.state().positions) - flat(points)).norm(), 1e-12);
  }
}

/// The static deflection of a slender beam's tip under a load there, by a time step of a million seconds.
double tip_deflection(Index across) {
  const double length = 10;
  auto [points, body] = box({10 * across, across, across}, {length, 1, 1}, MaterialModel::corotational);
  body.elasticity.lame = Lame::from_young(test::kYoung, 0);  // the clamp does not restrain lateral strain
  ImplicitOptions options = tight();
  options.time_step = 1e6;
  options.solve.max_iterations = 100'000;
  options.newton_iterations = 20;
  options.newton_tolerance = 1e-7;
  PrescribedMotion clamp;
  VertexForce load;
  const double force = 1e-4 * test::kYoung;
  for (Index v = 0; v < index_size(points); ++v) {
    if (points[v][0] == 0) clamp.vertices.push_back(v);
    if (points[v][0] == length) load.vertices.push_back(v);
  }
  load.newtons = {0, 0, -force / static_cast<double>(load.vertices.size())};
  options.prescribed.push_back(clamp);
  options.forces.push_back(load);
  options.solve.tolerance = 1e-9;
  BackwardEuler simulator(points, body, options);
  run(simulator, 1);
  double sum = 0;
  for (const Index v : load.vertices) sum += points[v][2] - simulator.state().positions[v][2];
  return sum / static_cast<double>(load.vertices.size());
}

TEST(BackwardEuler, AClampedBeamBendsTowardsEulerAndBernoulliWithRefinement) {
  // the deflection is P L³ / 3 E I with I = 1/12; a load of 1e-4 keeps it small. Shear adds 0.8 % at this
  // slenderness
  const double beam = 1e-4 * 1000 / 3 * 12;
  const double coarse = tip_deflection(3) / beam;
  const double fine = tip_deflection(6) / beam;
  EXPECT_LT(coarse, fine);
  EXPECT_LT(fine, 1.01);
  // the error of linear tetrahedra is quadratic in their size
  EXPECT_NEAR((4 * fine - coarse) / 3, 1.0, 0.03);
}

TEST(BackwardEuler, MovesTheSameInEveryOrder) {
  for (const MaterialModel model : kModels) {
    const auto [points, body] = box({4, 3, 2}, {4, 3, 2}, model);
    const MotionState start = disturbed(points, 0.05);
    ImplicitOptions options = tight();
    options.gravity = {0, -9.81, 0};
    options.prescribed.push_back({{{7}}, {}});
    options.forces.push_back({{{3}}, {50, 0, 0}});
    BackwardEuler simulator(points, body, options);
    simulator.set_state(start);
    run(simulator, 10);
    const MotionState expected = simulator.state();

    std::vector<Index> place(points.size());
    std::iota(place.begin(), place.end(), 0);
    Random random(5);
    for (std::size_t i = place.size(); i > 1; --i) std::swap(place[i - 1], place[random.below(i)]);
    std::vector<Point> moved_points(points.size());
    MotionState moved_start = start;
    for (std::size_t v = 0; v < points.size(); ++v) {
      moved_points[place[v]] = points[v];
      moved_start.positions[place[v]] = start.positions[v];
      moved_start.velocities[place[v]] = start.velocities[v];
    }
    Body moved = body;
    const Offset count = body.simplices.size();
    for (Offset s = 0; s < count; ++s) {
      for (int a = 0; a < 4; ++a) {
        moved.simplices.vertices[4 * ((s * 5) % count) + a] = place[body.simplices.vertices[4 * s + a]];
      }
    }
    ASSERT_NE(count % 5, 0);
    options.prescribed[0].vertices = {place[7]};
    options.forces[0].vertices = {place[3]};
    BackwardEuler other(moved_points, moved, options);
    other.set_state(moved_start);
    run(other, 10);
    const MotionState actual = other.state();
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(actual.positions[place[v]][c], expected.positions[v][c], 4e-8 * 1e-1);
      }
    }
  }
}

TEST(BackwardEuler, GivesTheSameBitsOnAnyNumberOfThreads) {
  const auto [points, body] = box({12, 12, 12}, {1, 1, 1}, MaterialModel::stvk);
  for (const PreconditionerKind preconditioner :
       {PreconditionerKind::jacobi, PreconditionerKind::block_jacobi, PreconditionerKind::incomplete_cholesky,
        PreconditionerKind::multigrid}) {
    std::vector<MotionState> ends;
    for (const std::size_t threads : test::kSanitized ? std::vector{1, 3} : std::vector{1, 2, 3}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      ImplicitOptions options;
      options.gravity = {0, -9.81, 0};
      options.preconditioner = preconditioner;
      options.precision =
          preconditioner == PreconditionerKind::jacobi ? MatrixPrecision::single : MatrixPrecision::double_;
      BackwardEuler simulator(points, body, options);
      simulator.set_state(disturbed(points, 0.002));
      run(simulator, 2);
      ends.push_back(simulator.state());
      EXPECT_EQ(ends.back().positions, ends.front().positions) << threads;
      EXPECT_EQ(ends.back().velocities, ends.front().velocities) << threads;
    }
  }
}

TEST(BackwardEuler, PreconditionersChangeOnlyTheWayToTheMotion) {
  const auto [points, body] = box({6, 4, 3}, {6, 4, 3}, MaterialModel::corotational);
  std::vector<Eigen::VectorXd> ends;
  std::vector<int> iterations;
  for (const PreconditionerKind preconditioner :
       {PreconditionerKind::jacobi, PreconditionerKind::block_jacobi, PreconditionerKind::incomplete_cholesky,
        PreconditionerKind::multigrid}) {
    ImplicitOptions options = tight();
    options.time_step = 0.1;
    options.gravity = {0, -9.81, 0};
    options.preconditioner = preconditioner;
    options.prescribed.push_back({{{0, 1, 2, 3, 4}}, {}});
    options.solve.tolerance = 1e-11;
    BackwardEuler simulator(points, body, options);
    simulator.set_state(disturbed(points, 0.02));
    iterations.push_back(simulator.step().cg_iterations);
    run(simulator, 4);
    ends.push_back(flat(simulator.state().positions));
    EXPECT_LT((ends.back() - ends.front()).norm(), 1e-8 * ends.front().norm()) << to_string(preconditioner);
    for (const Index held : {0, 1, 2, 3, 4}) EXPECT_EQ(simulator.state().velocities[held], Point{});
  }
  EXPECT_LT(iterations[2], iterations[1]);
  EXPECT_LT(iterations[3], iterations[0]);
}

TEST(BackwardEuler, GoesOnFromAStateBitForBit) {
  const auto [points, body] = box({3, 2, 2}, {1, 1, 1}, MaterialModel::neo_hookean);
  ImplicitOptions options;
  options.forces.push_back({{{1, 4}, 0.03, 0.05}, {10, 0, 3}});
  BackwardEuler whole(points, body, options);
  whole.set_state(disturbed(points, 0.01));
  BackwardEuler first = BackwardEuler(points, body, options);
  first.set_state(whole.state());
  run(whole, 8);
  run(first, 3);
  BackwardEuler second(points, body, options);
  second.set_state(first.state());
  run(second, 5);
  EXPECT_EQ(second.state().positions, whole.state().positions);
  EXPECT_EQ(second.state().velocities, whole.state().velocities);
}

TEST(BackwardEuler, AMatrixInSinglePrecisionMovesTheBodyTheSameWay) {
  // only half of the larger body's matrix is stored
  for (const bool large : {false, true}) {
    const std::array<int, 3> cells = large ? std::array{20, 16, 12} : std::array{4, 3, 2};
    const auto [points, body] = box(cells, {4, 3, 2}, MaterialModel::stvk);
    std::vector<Eigen::VectorXd> ends;
    for (const MatrixPrecision precision : {MatrixPrecision::double_, MatrixPrecision::single}) {
      ImplicitOptions options = tight();
      options.gravity = {0, -9.81, 0};
      options.precision = precision;
      options.solve.tolerance = 1e-11;
      BackwardEuler simulator(points, body, options);
      simulator.set_state(disturbed(points, large ? 0.005 : 0.05));
      run(simulator, large ? 2 : 5);
      ends.push_back(flat(simulator.state().positions));
      EXPECT_EQ(simulator.blocks_read() < simulator.system().matrix().block_count(), large);
    }
    EXPECT_LT((ends[1] - ends[0]).norm(), 1e-9 * ends[0].norm());
  }
}

TEST(BackwardEuler, ForcesActFromTheirStartToTheirEnd) {
  const auto [points, body] = box({1, 1, 1}, {1, 1, 1}, MaterialModel::stvk);
  ImplicitOptions options = tight();
  VertexForce force;
  for (Index v = 0; v < index_size(points); ++v) force.vertices.push_back(v);
  force.newtons = {1, 0, 0};
  force.from = 0.03;
  force.until = 0.07;
  options.forces.push_back(force);
  BackwardEuler simulator(points, body, options);
  const double impulse = 8 * options.time_step;
  for (int i = 0; i < 10; ++i) {
    run(simulator, 1);
    EXPECT_NEAR(simulator.balance().momentum[0], impulse * std::clamp(i - 2, 0, 4), 1e-9) << "step " << i;
  }
}

TEST(BackwardEuler, PrescribedVerticesMoveAsPrescribed) {
  const auto [points, body] = box({3, 1, 1}, {3, 1, 1}, MaterialModel::corotational);
  ImplicitOptions options = tight();
  options.gravity = {0, 0, -9.81};
  options.stiffness_damping = 0.01;
  options.prescribed.push_back({{{0, 1, 2, 3}}, {}});
  options.prescribed.push_back({{{12, 15}, 0, 0.05}, {0.2, 0, 0.1}});
  BackwardEuler simulator(points, body, options);
  run(simulator, 8);
  const MotionState state = simulator.state();
  for (const Index v : {0, 1, 2, 3}) EXPECT_EQ(state.positions[v], points[v]);
  EXPECT_NE(state.velocities[12], (Point{0.2, 0, 0.1}));  // free again
  run(simulator, 1);
  BackwardEuler again(points, body, options);
  run(again, 5);
  for (const Index v : {12, 15}) {
    EXPECT_NEAR(again.state().positions[v][0], points[v][0] + 0.01, 1e-15);
    EXPECT_NEAR(again.state().positions[v][2], points[v][2] + 0.005, 1e-15);
  }
}

TEST(BackwardEuler, VerticesOfNoElementStay) {
  auto [points, body] = box({1, 1, 1}, {1, 1, 1}, MaterialModel::corotational);
  points.push_back({7, 7, 7});
  ImplicitOptions options = tight();
  options.gravity = {0, -9.81, 0};
  options.forces.push_back({{{0, index_size(points) - 1}}, {0, -1, 0}});
  BackwardEuler simulator(points, body, options);
  run(simulator, 3);
  EXPECT_EQ(simulator.state().positions.back(), (Point{7, 7, 7}));
  EXPECT_LT(simulator.state().positions.front()[1], -0.005);
}

TEST(BackwardEuler, SaysThatTheMatrixIsIndefiniteAndGoesOn) {
  const auto [points, body] = box({3, 1, 1}, {3, 1, 1}, MaterialModel::stvk);
  ImplicitOptions options;
  options.time_step = 0.1;
  BackwardEuler simulator(points, body, options);
  MotionState pressed;
  pressed.positions = points;
  pressed.velocities.resize(points.size());
  for (Point& x : pressed.positions) x[0] *= 0.5;
  simulator.set_state(pressed);
  const StepReport report = simulator.step();
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_THAT(report.warnings[0], HasSubstr("not positive definite"));
  EXPECT_GT(report.cg_iterations, 0);
  // the pressed bar grows
  const MotionState after = simulator.state();
  EXPECT_GT(after.positions.back()[0] - after.positions.front()[0], 1.5);
}

TEST(BackwardEuler, SaysThatCgEndedEarly) {
  const auto [points, body] = box({3, 2, 2}, {3, 1, 1}, MaterialModel::corotational);
  ImplicitOptions options;
  options.solve.max_iterations = 2;
  BackwardEuler simulator(points, body, options);
  simulator.set_state(disturbed(points, 0.05));
  const StepReport report = simulator.step();
  EXPECT_EQ(report.cg_iterations, 2);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_THAT(report.warnings[0], HasSubstr("vertex"));
}

TEST(BackwardEuler, AMotionThatIsNotFiniteIsAnErrorAndChangesNothing) {
  const auto [points, body] = box({6, 4, 4}, {1, 1, 1}, MaterialModel::stvk);
  for (const PreconditionerKind preconditioner :
       {PreconditionerKind::jacobi, PreconditionerKind::block_jacobi, PreconditionerKind::incomplete_cholesky,
        PreconditionerKind::multigrid}) {
    ImplicitOptions options;
    options.preconditioner = preconditioner;
    BackwardEuler simulator(points, body, options);
    MotionState state = disturbed(points, 0.01);
    state.positions[3] = {1e200, 0, 0};
    simulator.set_state(state);
    try {
      simulator.step();
      FAIL() << "no error with " << to_string(preconditioner);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("step 1: "));
      EXPECT_THAT(error.what(), HasSubstr("vertex "));
    }
    EXPECT_EQ(simulator.state().positions, state.positions);
    EXPECT_EQ(simulator.state().step, 0);
  }
}

TEST(BackwardEuler, RefusesWhatMakesNoSense) {
  const auto [points, body] = box({1, 1, 1}, {1, 1, 1}, MaterialModel::stvk);
  const auto refuses = [&, &points = points, &body = body](const ImplicitOptions& options, const char* word) {
    try {
      const BackwardEuler simulator(points, body, options);
      FAIL() << word;
    } catch (const InvalidArgument& error) {
      EXPECT_THAT(error.what(), HasSubstr(word));
    }
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ImplicitOptions options;
  options.time_step = 0;
  refuses(options, "time step");
  options = {};
  options.mass_damping = -1;
  refuses(options, "alpha");
  options = {};
  options.stiffness_damping = kNan;
  refuses(options, "beta");
  options = {};
  options.gravity = {0, kNan, 0};
  refuses(options, "gravity is nan");
  options = {};
  options.forces.push_back({{{8}}, {}});
  refuses(options, "vertex");
  options = {};
  options.prescribed.push_back({{{1}}, {kNan, 0, 0}});
  refuses(options, "velocity");
  options = {};
  options.newton_iterations = 0;
  refuses(options, "Newton");

  Body flat_body = body;
  flat_body.simplices.vertices = {0, 1, 2, 1, 0, 1, 2, 2};
  EXPECT_THROW(BackwardEuler(points, flat_body, {}), InvalidArgument);
  Body surface = body;
  surface.simplices.dimension = 2;
  surface.simplices.vertices = {0, 1, 2};
  EXPECT_THROW(BackwardEuler(points, surface, {}), InvalidArgument);

  BackwardEuler simulator(points, body, {});
  MotionState state = simulator.state();
  state.positions.pop_back();
  EXPECT_THROW(simulator.set_state(state), InvalidArgument);
  state = simulator.state();
  state.velocities[2][1] = kNan;
  EXPECT_THROW(simulator.set_state(state), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
