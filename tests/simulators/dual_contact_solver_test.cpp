// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/dual_contact_solver.hpp"

#include "lab/contact/solve/remembered_forces.hpp"
#include "mesh/procedural.hpp"
#include "simulators/contact_problem.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

using test::ContactProblem;

/// A block that is pushed onto the floor. Some 500 vertices can touch the floor, and about half of them do.
ContactProblem pushed_block(double stiffness) {
  ContactProblem problem = test::contact_problem(make_grid({.size = test::kSanitized ? 10 : 20}), stiffness);
  problem.push({0.02, -0.1, 0});
  // a curved floor; a plane would touch all vertices
  for (Index v = 0; v < problem.size(); ++v) {
    const double* const x = problem.rest.data() + Offset{kPaddedStride} * v;
    if (x[1] > 0.02) continue;
    const double hill = -0.3 * ((x[0] - 0.4) * (x[0] - 0.4) + (x[2] - 0.5) * (x[2] - 0.5));
    problem.contacts.push_back({{v, -1, -1, -1}, {1, 0, 0, 0}, {0, 1, 0}, hill, 0.0, 0});
  }
  return problem;
}

TEST(DualContactSolver, NeedsFewMultiplicationsOnABlockThatIsPushedOntoTheFloor) {
  for (const double stiffness : {1.0, 100.0, 10'000.0}) {
    ContactProblem problem = pushed_block(stiffness);
    ASSERT_GT(problem.contacts.size(), test::kSanitized ? 100U : 400U);
    const CholeskyFactor<double> factor(problem.matrix);
    const auto solver = DualContactSolver<double>::make(problem.matrix, factor, {.tolerance = 1e-4});
    AlignedVector<double> x = problem.rest;
    const ContactSolveReport cold = solver->solve(problem.contacts, problem.b, problem.rest, x);
    EXPECT_TRUE(cold.converged);
    EXPECT_GE(cold.pushing, test::kSanitized ? 1 : 10);
    EXPECT_LT(cold.pushing, 400);
    EXPECT_LE(cold.iterations, 60);
    // the load changes a little
    problem.push({0, -0.001, 0.0005});
    const ContactSolveReport warm = solver->solve(problem.contacts, problem.b, problem.rest, x);
    EXPECT_TRUE(warm.converged);
    EXPECT_LE(warm.iterations, 25);
    const ContactSolveReport same = solver->solve(problem.contacts, problem.b, problem.rest, x);
    EXPECT_LE(same.iterations, 1);
    RecordProperty("cold_" + std::to_string(static_cast<int>(stiffness)), cold.iterations);
    RecordProperty("warm_" + std::to_string(static_cast<int>(stiffness)), warm.iterations);
    RecordProperty("pushing_" + std::to_string(static_cast<int>(stiffness)), cold.pushing);
  }
}

TEST(DualContactSolver, LeavesNoMoreDepthThanItsTolerance) {
  const ContactProblem problem = pushed_block(100.0);
  const CholeskyFactor<double> factor(problem.matrix);
  AlignedVector<double> x(problem.b.size());
  factor.solve(problem.b, x);
  double norm = 0.0;
  for (const Contact& contact : problem.contacts) {
    const double depth = std::max(0.0, contact.offset - x[Offset{kPaddedStride} * contact.vertices[0] + 1]);
    norm += depth * depth;
  }
  for (const double tolerance : {1e-1, 1e-3, 1e-6}) {
    const auto solver = DualContactSolver<double>::make(problem.matrix, factor, {.tolerance = tolerance});
    const ContactSolveReport report = solver->solve(problem.contacts, problem.b, problem.rest, x);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.violation, 2 * tolerance * std::sqrt(norm));
    EXPECT_LE(report.residual, 2 * tolerance);
  }
}

TEST(DualContactSolver, StopsAtTheLimitOfMultiplicationsAndSaysSo) {
  const ContactProblem problem = pushed_block(100.0);
  const CholeskyFactor<double> factor(problem.matrix);
  for (const int limit : {0, 1, 5}) {
    const auto solver =
        DualContactSolver<double>::make(problem.matrix, factor, {.tolerance = 1e-9, .max_iterations = limit});
    AlignedVector<double> x = problem.rest;
    const ContactSolveReport report = solver->solve(problem.contacts, problem.b, problem.rest, x);
    EXPECT_EQ(report.iterations, limit);
    EXPECT_FALSE(report.converged);
    for (const double c : x) EXPECT_LT(std::abs(c), 10.0);
  }
}

TEST(DualContactSolver, TakesForcesAlongWhereContactsComeAndGo) {
  ContactProblem problem = pushed_block(100.0);
  const CholeskyFactor<double> factor(problem.matrix);
  const auto solver = DualContactSolver<double>::make(problem.matrix, factor, {.tolerance = 1e-4});
  AlignedVector<double> x = problem.rest;
  const int cold = solver->solve(problem.contacts, problem.b, problem.rest, x).iterations;
  // contacts in another order, some of them removed
  std::reverse(problem.contacts.begin(), problem.contacts.end());
  problem.contacts.erase(problem.contacts.begin(), problem.contacts.begin() + 20);
  const int warm = solver->solve(problem.contacts, problem.b, problem.rest, x).iterations;
  EXPECT_LE(2 * warm, cold);
}

TEST(DualContactSolver, StaysWhereItIsWhenABodyJams) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 4}), 100.0);
  test::add_random_contacts(problem, 100, true, 11);
  for (Contact& contact : problem.contacts) contact.friction = 0.3;
  const CholeskyFactor<double> factor(problem.matrix);
  const auto solver = DualContactSolver<double>::make(problem.matrix, factor, {.max_iterations = 4000});
  AlignedVector<double> x = problem.rest;
  const ContactSolveReport report = solver->solve(problem.contacts, problem.b, problem.rest, x);
  EXPECT_FALSE(report.converged);
  EXPECT_LE(report.violation, 0.2);
  for (const double c : x) EXPECT_LT(std::abs(c), 2.0);
}

TEST(RememberedForces, AreThoseOfTheSameVertexAndObstacle) {
  const auto contact = [](Index vertex, std::int32_t with) {
    Contact result;
    result.vertices[0] = vertex;
    result.with = with;
    return result;
  };
  RememberedForces remembered;
  EXPECT_EQ(remembered.of(contact(3, 0)).normal, 0.0);
  remembered.remember(std::vector{contact(7, 1), contact(3, 2), contact(3, -1)},
                      std::vector<ContactForce>{{1.0, {4, 5, 6}}, {2.0, {}}, {3.0, {}}});
  EXPECT_EQ(remembered.of(contact(7, 1)).normal, 1.0);
  EXPECT_EQ(remembered.of(contact(7, 1)).along, (Point{4, 5, 6}));
  EXPECT_EQ(remembered.of(contact(3, 2)).normal, 2.0);
  EXPECT_EQ(remembered.of(contact(3, -1)).normal, 3.0);
  EXPECT_EQ(remembered.of(contact(3, 3)).normal, 0.0);
  EXPECT_EQ(remembered.of(contact(3, 0)).normal, 0.0);
  EXPECT_EQ(remembered.of(contact(7, 0)).normal, 0.0);
  EXPECT_EQ(remembered.of(contact(5, 1)).normal, 0.0);
  remembered.forget();
  EXPECT_EQ(remembered.of(contact(7, 1)).normal, 0.0);
}

}  // namespace
}  // namespace meshorder
