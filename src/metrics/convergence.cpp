// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/random.hpp"
#include "metrics/measures.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <vector>

namespace meshorder {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

constexpr double kOfDegree = 0.01;
constexpr double kResidual = 1e-8;
constexpr int kMostIterations = 1000;

/// One forward and one backward Gauss-Seidel sweep, as a preconditioner for Eigen's solvers.
class SymmetricGaussSeidel {
 public:
  using StorageIndex = Matrix::StorageIndex;
  enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic };

  // NOLINTNEXTLINE(readability-identifier-naming): Eigen's name
  SymmetricGaussSeidel& analyzePattern(const Matrix& /*matrix*/) { return *this; }
  SymmetricGaussSeidel& factorize(const Matrix& matrix) { return compute(matrix); }
  SymmetricGaussSeidel& compute(const Matrix& matrix) {
    matrix_ = matrix;  // a copy: the solver may pass a temporary
    diagonal_ = matrix.diagonal();
    return *this;
  }
  [[nodiscard]] Vector solve(const Vector& residual) const {
    Vector x = matrix_.triangularView<Eigen::Lower>().solve(residual);
    x.array() *= diagonal_.array();
    return matrix_.triangularView<Eigen::Upper>().solve(x);
  }
  [[nodiscard]] static Eigen::ComputationInfo info() { return Eigen::Success; }

 private:
  Matrix matrix_;
  Vector diagonal_;
};

/// Returns the graph's Laplacian in a new order, with a shift of the diagonal.
Matrix laplacian(GraphRef graph, const Permutation& order) {
  const CsrGraph moved = renumbered(graph, order.old_to_new());
  const Index n = moved.size();
  const double shift = kOfDegree * static_cast<double>(moved.neighbours.size()) / std::max(1, n);
  Matrix matrix(n, n);
  std::vector<int> entries(static_cast<std::size_t>(n));
  for (Index v = 0; v < n; ++v) entries[v] = moved.degree(v) + 1;
  matrix.reserve(entries);
  for (Index v = 0; v < n; ++v) {
    for (const Index u : moved[v]) matrix.insert(u, v) = -1;
    matrix.insert(v, v) = moved.degree(v) + (shift > 0 ? shift : 1);
  }
  matrix.makeCompressed();
  return matrix;
}

template <class Preconditioner>
int iterations(const Matrix& matrix, const Vector& right) {
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper, Preconditioner> solver;
  solver.setTolerance(kResidual);
  solver.setMaxIterations(kMostIterations);
  solver.compute(matrix);
  const Vector solution = solver.solve(right);
  return static_cast<int>(solver.iterations());
}

}  // namespace

Iterations iterations_in(GraphRef graph, const Permutation& order) {
  if (graph.size() == 0) return {};  // Eigen reads beyond the end of an empty matrix
  const Matrix matrix = laplacian(graph, order);
  Vector right(matrix.rows());
  Random random(1);
  for (const Index place : order.old_to_new()) right[place] = random.unit() - 0.5;
  using Factor = Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>>;
  return {.incomplete_cholesky = iterations<Factor>(matrix, right),
          .gauss_seidel = iterations<SymmetricGaussSeidel>(matrix, right)};
}

}  // namespace meshorder
