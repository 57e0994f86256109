// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/dual_contact_solver.hpp"
#include "mesh/procedural.hpp"
#include "simulators/contact_problem.hpp"
#include "support/sample_graphs.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <numbers>
#include <vector>

namespace meshorder {
namespace {

using test::compact;
using test::ContactProblem;

/// A run of one solver on one problem, from rest.
template <class Real>
struct Solved {
  CholeskyFactor<Real> factor;
  std::unique_ptr<DualContactSolver<Real>> solver;
  AlignedVector<Real> x;
  ContactSolveReport report;

  explicit Solved(const ContactProblem& problem, const ContactSolverOptions& options = {})
      : factor(problem.matrix),
        solver(DualContactSolver<Real>::make(problem.matrix, factor, options)),
        x(problem.rest.begin(), problem.rest.end()) {
    again(problem);
  }
  void again(const ContactProblem& problem) {
    const AlignedVector<Real> b(problem.b.begin(), problem.b.end());
    report = solver->solve(problem.contacts, b, problem.rest, x);
  }
  [[nodiscard]] Eigen::VectorXd forces() const {
    return Eigen::Map<const Eigen::VectorXd>(solver->forces().data(), index_size(solver->forces()));
  }
};

/// Solves up to rounding errors, in any number of iterations.
constexpr ContactSolverOptions kExact{.tolerance = 1e-11, .max_iterations = 100'000};

void expect_near(const Eigen::VectorXd& actual, const Eigen::VectorXd& expected, double tolerance) {
  ASSERT_EQ(actual.size(), expected.size());
  EXPECT_LE((actual - expected).cwiseAbs().maxCoeff(), tolerance);
}

TEST(ContactSolution, FindsTheSetOfPushingContactsThatEnumerationFinds) {
  int pushing = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ContactProblem problem = test::contact_problem(make_grid({.size = 2}), 3.0, seed);
    test::add_random_contacts(problem, 8, seed % 2 == 0, seed);
    const test::DenseSolution expected = test::by_enumeration(problem);
    ASSERT_GT(expected.x.size(), 0);
    Solved<double> run(problem, kExact);
    EXPECT_TRUE(run.report.converged) << seed;
    expect_near(compact(run.x), expected.x, 1e-8);
    expect_near(run.forces(), expected.forces, 1e-7);
    EXPECT_EQ(run.report.pushing, (run.forces().array() > 0).count());
    EXPECT_LE(run.report.violation, 1e-8);
    pushing += run.report.pushing;
  }
  // the problems are not trivial
  EXPECT_GT(pushing, 60);
  EXPECT_LT(pushing, 140);
}

TEST(ContactSolution, SolvesProblemsOfManyContactsAsCoordinateDescentDoes) {
  for (const bool with_itself : {false, true}) {
    ContactProblem problem = test::contact_problem(make_ball({.size = 4}), 5.0);
    test::add_random_contacts(problem, 50, with_itself, 7);
    const test::DenseSolution expected = test::by_coordinates(problem);
    Solved<double> run(problem, kExact);
    EXPECT_TRUE(run.report.converged);
    EXPECT_GT(run.report.pushing, 10);
    expect_near(compact(run.x), expected.x, 1e-7);
  }
}

TEST(ContactSolution, PushesOnlyWhereTheyTouchAndNeverPull) {
  ContactProblem problem = test::contact_problem(make_ball({.size = 8}), 20.0);
  problem.push({0, -1, 0});
  problem.add_plane({0, 1, 0}, -1.0, 1.0, 0);
  Solved<double> run(problem, kExact);
  EXPECT_TRUE(run.report.converged);
  const Eigen::VectorXd heights = test::dense_rows(problem) * compact(run.x) - test::offsets(problem);
  EXPECT_GE(run.forces().minCoeff(), 0.0);
  EXPECT_GE(heights.minCoeff(), -1e-8);
  EXPECT_LE(heights.cwiseProduct(run.forces()).cwiseAbs().maxCoeff(), 1e-6 * run.forces().maxCoeff());
  EXPECT_GT(run.report.pushing, 20);
  EXPECT_LT(run.report.pushing, heights.size() / 2);
}

TEST(ContactSolution, SolvesWithTheFactorAloneWhereNothingTouches) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 3}), 5.0);
  problem.push({1, 2, 3});
  Solved<double> run(problem);
  AlignedVector<double> expected(problem.b.size());
  CholeskyFactor<double>(problem.matrix).solve(problem.b, expected);
  EXPECT_EQ(run.x, expected);
  EXPECT_TRUE(run.report.converged);
  EXPECT_EQ(run.report.iterations, 0);
  EXPECT_EQ(run.report.violation, 0.0);
  EXPECT_TRUE(run.solver->forces().empty());
}

TEST(ContactSolution, LeavesContactsAloneThatAreFarAway) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 3}), 5.0);
  problem.add_plane({0, 1, 0}, -5.0, 10.0, 0);
  Solved<double> run(problem, kExact);
  expect_near(compact(run.x), compact(problem.rest), 1e-9);
  EXPECT_TRUE(run.report.converged);
  EXPECT_EQ(run.report.pushing, 0);
  EXPECT_EQ(run.report.violation, 0.0);
}

TEST(ContactSolution, SharesTheForceAmongContactsThatRepeatEachOther) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 3}), 5.0);
  problem.push({0, -1, 0});
  problem.add_plane({0, 1, 0}, 0.0, 0.1, 0);
  Solved<double> once(problem, kExact);
  problem.add_plane({0, 1, 0}, 0.0, 0.1, 1);
  problem.add_plane({0, 1, 0}, 0.0, 0.1, 2);
  Solved<double> thrice(problem, kExact);
  EXPECT_TRUE(thrice.report.converged);
  expect_near(compact(thrice.x), compact(once.x), 1e-8);
  EXPECT_NEAR(thrice.forces().sum(), once.forces().sum(), 1e-6 * once.forces().sum());
}

TEST(ContactSolution, EndsAndSaysSoWhereContactsContradictEachOther) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 3}), 5.0);
  problem.push({0, -1, 0});
  problem.add_plane({0, 1, 0}, 0.2, 0.3, 0);
  // the same vertices must be below −0.2
  problem.add_plane({0, -1, 0}, 0.2, 0.3, 1);
  for (Contact& contact : problem.contacts) {
    if (contact.with == 1) contact.vertices[0] = problem.contacts[0].vertices[0];
  }
  Solved<double> run(problem);
  EXPECT_FALSE(run.report.converged);
  EXPECT_GE(run.report.violation, 0.19);
  for (const double c : run.x) EXPECT_LT(std::abs(c), 3.0);
  for (const double force : run.solver->forces()) EXPECT_TRUE(std::isfinite(force));
  // the solver goes on from there, without the contradiction
  problem.contacts.resize(1);
  run.again(problem);
  EXPECT_TRUE(run.report.converged);
}

TEST(ContactSolution, KeepsTheMomentumOfABodyThatTouchesItself) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 4}), 5.0);
  test::add_random_contacts(problem, 40, true, 3);
  std::erase_if(problem.contacts, [](const Contact& contact) { return !contact.is_with_itself(); });
  for (Contact& contact : problem.contacts) contact.friction = 0.5;
  Solved<double> run(problem, kExact);
  EXPECT_TRUE(run.report.converged);
  EXPECT_GT(run.report.pushing, 5);
  // A x − b are the forces of contacts
  const Eigen::VectorXd forces = test::dense_in_space(problem.matrix) * compact(run.x) - compact(problem.b);
  EXPECT_GT(forces.cwiseAbs().maxCoeff(), 0.1);
  const Eigen::Vector3d sum = forces.reshaped(3, forces.size() / 3).rowwise().sum();
  EXPECT_LE(sum.norm(), 1e-7);
}

/// A block at rest on a slope that falls along +x by `angle`, for a time step of 0.01 s.
ContactProblem block_on_slope(double angle, double friction) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 3}), 2000.0);
  const double fall = 9.81 * 1e-4;
  problem.push({fall * std::sin(angle), -fall * std::cos(angle), 0});
  problem.add_plane({0, 1, 0}, 0.0, 0.1, 0, friction);
  return problem;
}

TEST(ContactSolution, HoldsABlockOnASlopeThatIsLessSteepThanTheFriction) {
  const double angle = 0.3;
  ContactProblem problem = block_on_slope(angle, 1.1 * std::tan(angle));
  Solved<double> run(problem, kExact);
  EXPECT_TRUE(run.report.converged);
  const double total = Eigen::Map<Eigen::VectorXd>(problem.masses.data(), problem.size()).sum();
  const Eigen::VectorXd moved = compact(run.x) - compact(problem.rest);
  const Eigen::VectorXd pull = test::dense_in_space(problem.matrix) * compact(run.x) - compact(problem.b);
  const Eigen::Vector3d force = pull.reshaped(3, pull.size() / 3).rowwise().sum();
  // the forces that hold a block at rest, up to the solver's softness
  const double weight = total * 9.81 * 1e-4;
  EXPECT_NEAR(force.x(), -weight * std::sin(angle), 0.02 * weight);
  EXPECT_NEAR(force.y(), weight * std::cos(angle), 0.02 * weight);
  EXPECT_LE(moved.cwiseAbs().maxCoeff(), 0.01 * 9.81 * 1e-4);
}

TEST(ContactSolution, LetsABlockSlideDownASlopeThatIsSteeperThanTheFriction) {
  const double angle = 0.5;
  const double friction = 0.6 * std::tan(angle);
  ContactProblem problem = block_on_slope(angle, friction);
  Solved<double> run(problem, kExact);
  EXPECT_TRUE(run.report.converged);
  const Eigen::VectorXd pull = test::dense_in_space(problem.matrix) * compact(run.x) - compact(problem.b);
  const Eigen::Vector3d force = pull.reshaped(3, pull.size() / 3).rowwise().sum();
  EXPECT_NEAR(force.x(), -friction * force.y(), 1e-6 * force.y());
  EXPECT_NEAR(force.z(), 0.0, 0.01 * force.y());
  const Eigen::VectorXd moved = compact(run.x) - compact(problem.rest);
  double along = 0.0;
  double total = 0.0;
  for (Index v = 0; v < problem.size(); ++v) {
    along += problem.masses[v] * moved(3 * v);
    total += problem.masses[v];
  }
  // it stays on the plane, so the centre of mass moves like that of a rigid block
  const double rigid = 9.81 * 1e-4 * (std::sin(angle) - friction * std::cos(angle));
  EXPECT_NEAR(along / total, rigid, 0.02 * rigid);
}

TEST(ContactSolution, KeepsForcesWithinTheConeOfFrictionAndAgainstTheMotion) {
  for (const double friction : {0.1, 0.5, 2.0}) {
    ContactProblem problem = test::contact_problem(make_ball({.size = 6}), 20.0);
    problem.push({0.3, -1, 0.1});
    problem.add_plane({0, 1, 0}, -1.0, 0.7, 0, friction);
    Solved<double> run(problem, kExact);
    EXPECT_TRUE(run.report.converged) << friction;
    const Eigen::VectorXd pull = test::dense_in_space(problem.matrix) * compact(run.x) - compact(problem.b);
    const Eigen::VectorXd moved = compact(run.x) - compact(problem.rest);
    int sticking = 0;
    int sliding = 0;
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
      const Index v = problem.contacts[k].vertices[0];
      const double normal = run.solver->forces()[k];
      const Eigen::Vector2d along(pull(3 * v), pull(3 * v + 2));
      const Eigen::Vector2d slip(moved(3 * v), moved(3 * v + 2));
      EXPECT_NEAR(pull(3 * v + 1), normal, 1e-6);
      EXPECT_LE(along.norm(), friction * normal + 1e-6);
      if (normal <= 1e-6) continue;
      if (slip.norm() <= 1e-7) {
        ++sticking;
      } else {
        ++sliding;
        EXPECT_NEAR(along.dot(slip), -friction * normal * slip.norm(), 1e-6);
      }
    }
    EXPECT_GT(sticking + sliding, 15);
    EXPECT_GT(friction < 0.2 ? sliding : 16, 15);
    EXPECT_GT(friction > 1.0 ? sticking : 16, 15);
  }
}

TEST(ContactSolution, ConvergesForStiffBodies) {
  for (const double stiffness : {1e3, 1e5}) {
    ContactProblem problem = test::contact_problem(make_grid({.size = 4}), stiffness);
    problem.push({0, -1, 0});
    problem.add_plane({0, 1, 0}, -0.1, 0.2, 0);
    const test::DenseSolution expected = test::by_coordinates(problem);
    Solved<double> run(problem, {.tolerance = 1e-6, .max_iterations = 1'000'000});
    EXPECT_TRUE(run.report.converged);
    expect_near(compact(run.x), expected.x, 1e-5);
    RecordProperty("iterations_" + std::to_string(static_cast<int>(stiffness)), run.report.iterations);
  }
}

TEST(ContactSolution, GivesTheSameBitsForAnyNumberOfThreads) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 16}), 30.0);
  problem.push({0, -1, 0.2});
  problem.add_plane({0, 1, 0}, 0.0, 0.05, 0, 0.2);
  test::add_random_contacts(problem, 40, true, 2);
  const Solved<double> expected(problem, {.max_iterations = 60});
  for (const std::size_t threads : test::kSanitized ? std::vector{1, 3} : std::vector{1, 2, 3, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Solved<double> run(problem, {.max_iterations = 60});
    EXPECT_EQ(run.x, expected.x);
    EXPECT_EQ(run.report.iterations, expected.report.iterations);
  }
}

TEST(ContactSolution, WorksInSinglePrecision) {
  ContactProblem problem = test::contact_problem(make_ball({.size = 6}), 20.0);
  problem.push({0.2, -1, 0});
  problem.add_plane({0, 1, 0}, -1.0, 0.7, 0, 0.3);
  test::add_random_contacts(problem, 20, true, 2);
  const Solved<double> expected(problem, kExact);
  const Solved<float> run(problem, {.tolerance = 1e-4, .max_iterations = 2000});
  EXPECT_TRUE(run.report.converged);
  expect_near(compact(run.x), compact(expected.x), 3e-3);
  EXPECT_LE(run.report.violation, 1e-3);
}

TEST(ContactSolution, ForgetsForcesWhenAskedTo) {
  ContactProblem problem = test::contact_problem(make_ball({.size = 6}), 20.0);
  problem.push({0, -1, 0});
  problem.add_plane({0, 1, 0}, -1.0, 0.7, 0, 0.3);
  Solved<double> run(problem, {.max_iterations = 2000});
  const AlignedVector<double> first = run.x;
  const int iterations = run.report.iterations;
  run.again(problem);
  EXPECT_LE(run.report.iterations, iterations / 2);
  run.solver->forget();
  run.x = problem.rest;
  run.again(problem);
  EXPECT_EQ(run.report.iterations, iterations);
  EXPECT_EQ(run.x, first);
}

TEST(ContactSolution, RefusesContactsThatAreNone) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 2}), 5.0);
  problem.add_plane({0, 1, 0}, 0.0, 0.1, 0);
  const auto refused = [&](const auto& spoil) {
    ContactProblem spoilt = problem;
    spoil(spoilt.contacts[1]);
    EXPECT_THROW((Solved<double>{spoilt}), InvalidArgument);
  };
  refused([&](Contact& contact) { contact.vertices[0] = problem.size(); });
  refused([](Contact& contact) { contact.vertices[0] = Contact::kAbsent; });
  refused([](Contact& contact) { contact.vertices[2] = -7; });
  refused([](Contact& contact) { contact.offset = std::numeric_limits<double>::quiet_NaN(); });
  refused([](Contact& contact) { contact.normal[1] = std::numeric_limits<double>::infinity(); });
  refused([](Contact& contact) { contact.weights[0] = 0.0; });
  refused([](Contact& contact) { contact.friction = -0.1; });
}

TEST(ContactSolution, RefusesVectorsOfAnotherSize) {
  const ContactProblem problem = test::contact_problem(make_grid({.size = 2}), 5.0);
  Solved<double> run(problem);
  AlignedVector<double> wrong(problem.b.size() - 4);
  EXPECT_THROW(run.solver->solve({}, wrong, problem.rest, run.x), InvalidArgument);
  EXPECT_THROW(run.solver->solve({}, problem.b, wrong, run.x), InvalidArgument);
  EXPECT_THROW(run.solver->solve({}, problem.b, problem.rest, wrong), InvalidArgument);
}

TEST(ContactSolution, RefusesOptionsThatAreOutOfRange) {
  const ContactProblem problem = test::contact_problem(make_grid({.size = 2}), 5.0);
  for (const ContactSolverOptions& options :
       {ContactSolverOptions{.tolerance = 0.0}, ContactSolverOptions{.tolerance = -1.0},
        ContactSolverOptions{.max_iterations = -1}}) {
    EXPECT_THROW(Solved<double>(problem, options), InvalidArgument);
  }
}

}  // namespace
}  // namespace meshorder
