// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/error.hpp"
#include "lab/contact/solve/coloured_rows.hpp"
#include "lab/contact/solve/contact_solver.hpp"
#include "lab/contact/solve/node_contacts.hpp"
#include "mesh/procedural.hpp"
#include "simulators/contact_problem.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

using test::compact;
using test::ContactProblem;

/// ½xᵀA x − bᵀx
double energy(const ContactProblem& problem, const AlignedVector<double>& x) {
  const Eigen::VectorXd all = compact(x);
  return 0.5 * all.dot(compact(test::product(problem.matrix, x))) - all.dot(compact(problem.b));
}

TEST(ColouredRows, HaveNoTwoNeighboursOfOneColour) {
  for (const Mesh& mesh : {make_grid({.size = 6}), make_torus({.size = 2})}) {
    const ContactProblem problem = test::contact_problem(mesh, 3.0);
    const ColouredRows<double> rows(problem.matrix);
    ASSERT_EQ(rows.size(), problem.size());
    ASSERT_EQ(rows.colours().front(), 0);
    ASSERT_EQ(rows.colours().back(), problem.size());
    EXPECT_LE(rows.colours().size(), 16U);
    const auto colour_of = [&](Index v) {
      return std::upper_bound(rows.colours().begin(), rows.colours().end(), rows.place_of(v)) -
             rows.colours().begin();
    };
    std::vector<bool> seen(static_cast<std::size_t>(problem.size()));
    for (Index v = 0; v < problem.size(); ++v) {
      EXPECT_FALSE(seen[rows.place_of(v)]);
      seen[rows.place_of(v)] = true;
      for (Offset k = problem.matrix.offsets[v]; k < problem.matrix.offsets[v + 1]; ++k) {
        const Index other = problem.matrix.columns[k];
        if (other == v) {
          EXPECT_EQ(rows.diagonal(v), problem.matrix.values[k]);
        } else {
          EXPECT_NE(colour_of(v), colour_of(other));
        }
      }
    }
  }
}

template <class Real>
void expect_dense_relaxation(double tolerance) {
  ContactProblem problem = test::contact_problem(make_ball({.size = 4}), 3.0);
  problem.push({1, -2, 3});
  const ColouredRows<Real> rows(problem.matrix);
  AlignedVector<Real> x(problem.rest.begin(), problem.rest.end());
  const AlignedVector<Real> b(problem.b.begin(), problem.b.end());
  const Eigen::MatrixXd matrix = test::dense(problem.matrix);
  Eigen::VectorXd expected = compact(x);
  double sum = 0.0;
  double expected_sum = 0.0;
  for (std::size_t colour = 0; colour + 1 < rows.colours().size(); ++colour) {
    const Eigen::VectorXd residual = compact(b) - matrix * expected;
    for (Index v = 0; v < problem.size(); ++v) {
      const Index place = rows.place_of(v);
      if (place < rows.colours()[colour] || place >= rows.colours()[colour + 1]) continue;
      const Point one = rows.residual(v, std::span<const Real>(b), std::span<const Real>(x));
      for (Index c = 0; c < 3; ++c) {
        const double diagonal = matrix(3 * v, 3 * v);
        EXPECT_NEAR(one[static_cast<std::size_t>(c)], residual(3 * v + c), 100 * tolerance);
        const double change = 1.3 * residual(3 * v + c) / diagonal;
        expected(3 * v + c) += change;
        expected_sum += diagonal * change * change;
      }
    }
    // in pieces that are no whole vectors
    const Index middle = (rows.colours()[colour] + rows.colours()[colour + 1]) / 2;
    sum += rows.relax(rows.colours()[colour], middle, Real(1.3), b, x);
    sum += rows.relax(middle, rows.colours()[colour + 1], Real(1.3), b, x);
  }
  EXPECT_LE((compact(x) - expected).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_NEAR(sum, expected_sum, 100 * tolerance * expected_sum);
}

TEST(ColouredRows, RelaxAsTheDenseMatrixSays) {
  expect_dense_relaxation<double>(1e-13);
  expect_dense_relaxation<float>(1e-5);
}

TEST(ColouredRows, RefuseAMatrixWithoutADiagonal) {
  SparseMatrix matrix;
  matrix.offsets = {0, 1, 2};
  matrix.columns = {0, 0};
  matrix.values = {1.0, 1.0};
  EXPECT_THROW(ColouredRows<double>{matrix}, InvalidArgument);
}

/// A corner's contacts on one vertex: the least ½‖x − aim‖² above up to three planes.
TEST(NodeContacts, ProjectOntoTheCornerThatSeveralObstaclesLeave) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    ContactProblem problem;
    problem.matrix = {{0, 1}, {0}, {1.0}};
    problem.rest = padded_positions(std::vector<Point>{{0, 0, 0}});
    Random random(seed);
    problem.b = problem.rest;
    for (Index c = 0; c < 3; ++c) problem.b[c] = 2 * random.unit() - 1;
    test::add_random_contacts(problem, 1 + static_cast<int>(seed % 3), false, seed);
    const test::DenseSolution expected = test::by_enumeration(problem);
    ASSERT_EQ(expected.x.size(), 3);
    // planes that are all but parallel meet far away
    if (expected.x.norm() > 2.0) continue;
    NodeContacts nodes;
    nodes.set(problem.contacts, std::vector<ContactForce>(problem.contacts.size()), problem.rest,
              [](Index) { return 1.0; });
    ASSERT_EQ(nodes.size(), 1);
    EXPECT_FALSE(nodes.is_tied(0));
    // forces of the last time serve as a start
    for (int time = 0; time < 40; ++time) {
      Point x{problem.b[0], problem.b[1], problem.b[2]};
      nodes.project(problem.contacts, 0, 1.0, x);
      if (time == 39 || problem.contacts.size() == 1) {
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(x[c], expected.x(static_cast<Eigen::Index>(c)), 1e-6) << seed;
      }
    }
  }
}

TEST(GaussSeidel, LowersTheEnergyWithEverySweep) {
  for (const double relaxation : {0.3, 1.0, 1.5, 1.9, 1.99}) {
    ContactProblem problem = test::contact_problem(make_grid({.size = 5}), 30.0);
    problem.push({0, -1, 0.4});
    problem.add_plane({0, 1, 0}, 0.05, 0.3, 0);
    problem.add_plane({0.6, 0.8, 0}, 0.1, 0.3, 1);
    const CholeskyFactor<double> factor(problem.matrix);
    const auto solver = ContactSolver<double>::make(
        problem.matrix, factor,
        {.kind = ContactSolverKind::gauss_seidel, .max_iterations = 1, .over_relaxation = relaxation});
    AlignedVector<double> x = problem.rest;
    // the first sweep leads out of the obstacles
    (void)solver->solve(problem.contacts, problem.b, problem.rest, x);
    double before = energy(problem, x);
    for (int sweep = 0; sweep < 200; ++sweep) {
      EXPECT_EQ(solver->solve(problem.contacts, problem.b, problem.rest, x).iterations, 1);
      const double now = energy(problem, x);
      EXPECT_LE(now, before + 1e-12 * std::abs(before)) << relaxation << ' ' << sweep;
      before = now;
    }
  }
}

TEST(GaussSeidel, ConvergesWhereTheBodyIsTiedToItselfAllOver) {
  for (const double relaxation : {1.0, 1.5, 1.9}) {
    ContactProblem problem = test::contact_problem(make_grid({.size = 4}), 100.0);
    test::add_random_contacts(problem, 100, true, 11);
    const CholeskyFactor<double> factor(problem.matrix);
    const auto solver = ContactSolver<double>::make(problem.matrix, factor,
                                                    {.kind = ContactSolverKind::gauss_seidel,
                                                     .tolerance = 1e-6,
                                                     .max_iterations = 1000,
                                                     .over_relaxation = relaxation});
    AlignedVector<double> x = problem.rest;
    const ContactSolveReport report = solver->solve(problem.contacts, problem.b, problem.rest, x);
    EXPECT_TRUE(report.converged) << relaxation;
    EXPECT_GT(report.pushing, 30);
    EXPECT_LE((compact(x) - test::by_coordinates(problem).x).cwiseAbs().maxCoeff(), 1e-3) << relaxation;
  }
}

TEST(GaussSeidel, StaysWhereItIsWhenABodyJams) {
  for (const double relaxation : {1.0, 1.9, 1.99}) {
    ContactProblem problem = test::contact_problem(make_grid({.size = 4}), 1e4);
    test::add_random_contacts(problem, 300, true, 11);
    for (Contact& contact : problem.contacts) contact.friction = 0.3;
    const CholeskyFactor<double> factor(problem.matrix);
    const auto solver = ContactSolver<double>::make(
        problem.matrix, factor,
        {.kind = ContactSolverKind::gauss_seidel, .max_iterations = 400, .over_relaxation = relaxation});
    AlignedVector<double> x = problem.rest;
    const ContactSolveReport report = solver->solve(problem.contacts, problem.b, problem.rest, x);
    EXPECT_FALSE(report.converged);
    EXPECT_LE(report.violation, 0.25);
    for (const double c : x) EXPECT_LT(std::abs(c), 2.0);
  }
}

TEST(GaussSeidel, StopsAtTheIterationLimitAndSaysSo) {
  ContactProblem problem = test::contact_problem(make_grid({.size = 5}), 1e3);
  problem.push({0, -1, 0});
  problem.add_plane({0, 1, 0}, 0.0, 0.3, 0);
  const CholeskyFactor<double> factor(problem.matrix);
  for (const int limit : {0, 1, 7}) {
    const auto solver = ContactSolver<double>::make(
        problem.matrix, factor, {.kind = ContactSolverKind::gauss_seidel, .max_iterations = limit});
    AlignedVector<double> x = problem.rest;
    const ContactSolveReport report = solver->solve(problem.contacts, problem.b, problem.rest, x);
    EXPECT_EQ(report.iterations, limit);
    EXPECT_FALSE(report.converged);
  }
}

}  // namespace
}  // namespace meshorder
