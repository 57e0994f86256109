// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/hierarchy.hpp"

#include "support/dense.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace meshorder {
namespace {

/// Graphs with more than one level, small enough for dense solvers.
std::vector<test::NamedGraph> small_graphs() {
  const Index n = test::kSanitized ? 120 : 400;
  return {{"path", test::path(n)},
          {"grid", test::grid(n / 20, 18)},
          {"box", test::grid(n / 50, 8, 7)},
          {"random", test::random_connected(n, 2 * n, 1)},
          {"tree", test::random_connected(n, 0, 2)},
          {"power law", test::preferential_attachment(n, 2, 3)},
          {"star", test::star(n)},
          {"complete", test::complete(n)},
          {"expander", test::random_regular(n, 6, 4)}};
}

Hierarchy hierarchy_of(const CsrGraph& graph) { return Hierarchy(test::combinatorial_laplacian(graph)); }

/// P from level `level` + 1 to `level`, column by column.
Eigen::MatrixXd dense_prolongation(const Hierarchy& hierarchy, int level) {
  const Index fine = hierarchy.levels()[level].laplacian.size();
  const Index coarse = hierarchy.levels()[level + 1].laplacian.size();
  Eigen::MatrixXd result(fine, coarse);
  for (Index column = 0; column < coarse; ++column) {
    VectorBlock<1> unit(coarse, {0.0});
    unit[column][0] = 1;
    VectorBlock<1> image(fine, {0.0});
    hierarchy.add_prolonged<1>(level, 1, unit, image);
    for (Index v = 0; v < fine; ++v) result(v, column) = image[v][0];
  }
  return result;
}

/// The cycle on level 0 as a matrix on the vectors that sum to 0: C M C with the centring matrix C.
Eigen::MatrixXd dense_cycle(const Hierarchy& hierarchy) {
  const Index n = hierarchy.levels()[0].laplacian.size();
  const Eigen::MatrixXd centring = Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Constant(n, n, 1.0 / n);
  Eigen::MatrixXd result(n, n);
  for (Index column = 0; column < n; ++column) {
    VectorBlock<1> b(n);
    for (Index v = 0; v < n; ++v) b[v][0] = centring(v, column);
    VectorBlock<1> x;
    CycleWorkspace<1> workspace;
    hierarchy.cycle<1>(0, b, x, workspace);
    for (Index v = 0; v < n; ++v) result(v, column) = x[v][0];
  }
  return centring * result;
}

TEST(Hierarchy, CoarseOperatorsAreSymmetricAndAnnihilateConstants) {
  for (const auto& [name, graph] : small_graphs()) {
    SCOPED_TRACE(name);
    const Hierarchy hierarchy = hierarchy_of(graph);
    ASSERT_GE(hierarchy.levels().size(), 2U);
    for (const Level& level : hierarchy.levels()) {
      const Eigen::MatrixXd matrix = test::dense(level.laplacian);
      const double scale = std::max(1.0, matrix.cwiseAbs().maxCoeff());
      EXPECT_LE((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 1e-13 * scale);
      EXPECT_LE(matrix.rowwise().sum().cwiseAbs().maxCoeff(), 1e-12 * scale);
      const double lowest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues()[0];
      EXPECT_GE(lowest, -1e-12 * scale);
    }
  }
}

TEST(Hierarchy, CoarseOperatorsAreGalerkinProducts) {
  std::vector<test::NamedGraph> graphs = small_graphs();
  // these have levels of smoothed coarsening, too
  graphs.push_back({"larger grid", test::grid(35, 20)});
  graphs.push_back({"sparse", test::random_connected(800, 300, 5)});
  Index smoothed = 0;
  for (const auto& [name, graph] : graphs) {
    SCOPED_TRACE(name);
    const Hierarchy hierarchy = hierarchy_of(graph);
    for (int level = 0; level + 1 < static_cast<int>(hierarchy.levels().size()); ++level) {
      if (hierarchy.levels()[level].is_smoothed()) ++smoothed;
      const Eigen::MatrixXd p = dense_prolongation(hierarchy, level);
      EXPECT_LE((p.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-14) << "constants stay constant";
      const Eigen::MatrixXd coarse = test::dense(hierarchy.levels()[level + 1].laplacian);
      VectorBlock<1> x(p.rows());
      VectorBlock<1> image(p.rows());
      Eigen::VectorXd y(p.rows());
      for (Index column = 0; column < coarse.cols(); ++column) {
        for (Index v = 0; v < p.rows(); ++v) x[v][0] = p(v, column);
        hierarchy.levels()[level].laplacian.apply<1>(x, image);
        for (Index v = 0; v < p.rows(); ++v) y[v] = image[v][0];
        ASSERT_LE((p.transpose() * y - coarse.col(column)).cwiseAbs().maxCoeff(), 1e-12 * graph.size());
      }
    }
  }
  EXPECT_GE(smoothed, 2);
}

TEST(Hierarchy, MassesCountTheVerticesOfTheFinestGraph) {
  for (const auto& [name, graph] : small_graphs()) {
    SCOPED_TRACE(name);
    const Hierarchy hierarchy = hierarchy_of(graph);
    for (const Level& level : hierarchy.levels()) {
      double sum = 0;
      for (Index v = 0; v < level.laplacian.size(); ++v) {
        EXPECT_GE(level.mass(v), 1);
        sum += level.mass(v);
      }
      EXPECT_DOUBLE_EQ(sum, graph.size());
    }
  }
}

TEST(Hierarchy, TheCycleIsSymmetricAndPositiveOnVectorsThatSumToZero) {
  for (const auto& [name, graph] : small_graphs()) {
    SCOPED_TRACE(name);
    const Eigen::MatrixXd cycle = dense_cycle(hierarchy_of(graph));
    const double scale = cycle.cwiseAbs().maxCoeff();
    ASSERT_TRUE(std::isfinite(scale));
    EXPECT_LE((cycle - cycle.transpose()).cwiseAbs().maxCoeff(), 1e-11 * scale);
    const Eigen::MatrixXd symmetric = 0.5 * (cycle + cycle.transpose());
    // one eigenvalue is the 0 of the constant vector
    const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues();
    EXPECT_GT(values[1], 1e-3 / graph.size());
    EXPECT_GE(values[0], -1e-11 * scale);
  }
}

TEST(Hierarchy, TheCycleIsCloseToTheInverse) {
  // the error operator I − M L of one cycle: the iteration does not diverge if its energy norm is at most 1
  for (const auto& [name, graph] : small_graphs()) {
    SCOPED_TRACE(name);
    const auto exact = test::dense_eigen(graph);
    const Index n = graph.size();
    const Eigen::VectorXd root = exact.eigenvalues().tail(n - 1).cwiseSqrt();
    const Eigen::MatrixXd modes = exact.eigenvectors().rightCols(n - 1);
    const Eigen::MatrixXd preconditioned =
        root.asDiagonal() * modes.transpose() * dense_cycle(hierarchy_of(graph)) * modes * root.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        0.5 * (preconditioned + preconditioned.transpose()));
    EXPECT_GT(solver.eigenvalues()[0], 0.01);
    // the cycle doubles the corrections of plain coarsening
    EXPECT_LT(solver.eigenvalues()[n - 2], 2 + 1e-9);
  }
}

TEST(Hierarchy, SeveralColumnsAreThoseOfOneAtATime) {
  const Hierarchy hierarchy = hierarchy_of(test::grid(25, 18));
  std::mt19937 random(1);
  VectorBlock<2> b(450);
  for (auto& row : b) {
    for (double& entry : row) entry = static_cast<double>(random() % 1000U) / 1000 - 0.5;
  }
  VectorBlock<2> x;
  CycleWorkspace<2> workspace;
  hierarchy.cycle<2>(0, b, x, workspace);
  for (int m = 0; m < 2; ++m) {
    VectorBlock<1> one(450);
    for (Index v = 0; v < 450; ++v) one[v][0] = b[v][m];
    VectorBlock<1> y;
    CycleWorkspace<1> workspace_of_one;
    hierarchy.cycle<1>(0, one, y, workspace_of_one);
    for (Index v = 0; v < 450; ++v) ASSERT_NEAR(y[v][0], x[v][m], 1e-9);
  }
}

TEST(Hierarchy, TheCoarsestLevelIsSolvedExactly) {
  // up to 60 vertices there is one level, and the cycle is the pseudo-inverse
  for (const CsrGraph& graph : {test::path(2), test::grid(8, 7), test::random_connected(60, 30, 1)}) {
    const Hierarchy hierarchy = hierarchy_of(graph);
    ASSERT_EQ(hierarchy.levels().size(), 1U);
    ASSERT_TRUE(hierarchy.has_exact_coarsest());
    const auto exact = test::dense_eigen(graph);
    const Index n = graph.size();
    const Eigen::MatrixXd modes = exact.eigenvectors().rightCols(n - 1);
    const Eigen::MatrixXd inverse =
        modes * exact.eigenvalues().tail(n - 1).cwiseInverse().asDiagonal() * modes.transpose();
    EXPECT_LE((dense_cycle(hierarchy) - inverse).cwiseAbs().maxCoeff(), 1e-10);

    const VectorBlock<2> vectors = hierarchy.coarsest_eigenvectors<2>();
    const Eigen::MatrixXd matrix = test::dense_laplacian(graph);
    for (int m = 0; m < std::min<int>(2, n - 1); ++m) {
      Eigen::VectorXd x(n);
      for (Index v = 0; v < n; ++v) x[v] = vectors[v][m];
      EXPECT_NEAR(x.norm(), 1, 1e-12);
      EXPECT_LE((matrix * x - exact.eigenvalues()[m + 1] * x).norm(), 1e-11);
    }
  }
}

TEST(Hierarchy, SmoothingDampsWhatIsRough) {
  const CsrGraph graph = test::grid(30, 30);
  const Hierarchy hierarchy = hierarchy_of(graph);
  VectorBlock<1> rough(900), constant(900, {3.0});
  for (Index v = 0; v < 900; ++v) rough[v][0] = (v + v / 30) % 2 == 0 ? 1 : -1;  // a chessboard
  hierarchy.smooth<1>(0, rough);
  hierarchy.smooth<1>(0, constant);
  double squares = 0;
  for (const auto& row : rough) squares += row[0] * row[0];
  EXPECT_LT(squares, 0.1 * 900);
  for (const auto& row : constant) EXPECT_DOUBLE_EQ(row[0], 3);
}

TEST(Hierarchy, OfOneVertexGivesZero) {
  for (const CsrGraph& graph : {test::path(1), test::star(1000), test::complete(150)}) {
    const Hierarchy hierarchy = hierarchy_of(graph);
    const int last = static_cast<int>(hierarchy.levels().size()) - 1;
    ASSERT_EQ(hierarchy.levels()[last].laplacian.size(), 1);
    VectorBlock<1> x;
    CycleWorkspace<1> workspace;
    hierarchy.cycle<1>(last, {{1e-16}}, x, workspace);
    EXPECT_EQ(x[0][0], 0) << "rounding must not grow to a correction";
  }
}

TEST(Hierarchy, CoarsensQuickly) {
  for (const auto& [graph, levels] : {std::pair(test::path(20000), 7U), std::pair(test::grid(100, 100), 4U),
                                      std::pair(test::grid(20, 20, 20), 4U), std::pair(test::star(20000), 2U),
                                      std::pair(test::preferential_attachment(5000, 2, 1), 4U)}) {
    const Hierarchy hierarchy = hierarchy_of(graph);
    EXPECT_TRUE(hierarchy.has_exact_coarsest());
    EXPECT_LE(hierarchy.levels().size(), levels);
    std::size_t entries = 0;
    for (const Level& level : hierarchy.levels()) entries += level.laplacian.neighbours.size();
    EXPECT_LE(static_cast<double>(entries), 4.0 * static_cast<double>(graph.neighbours.size()));
  }
}

}  // namespace
}  // namespace meshorder
