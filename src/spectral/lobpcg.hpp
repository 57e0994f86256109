// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/polymorphic.hpp"
#include "base/run_scope.hpp"
#include "spectral/hierarchy.hpp"

#include <array>
#include <span>

namespace meshorder {

struct LobpcgOptions {
  double tolerance = 0.1;    ///< convergence limit on ‖L x − λ B x‖ / (λ ‖x‖) of the first column
  int max_iterations = 500;  ///< limit on the iterations
  TimeLimit limit = {};      ///< ends the iteration, like max_iterations
  bool until_calm = false;   ///< ends the iteration when all columns have settled, whatever the tolerance
};

struct LobpcgResult {
  double eigenvalue = 0;  ///< eigenvalue of the first column
  double residual = 0;    ///< ‖L x − λ B x‖ / ‖x‖ of the first column
  int iterations = 0;
  bool converged = false;
};

/// A problem L x = λ B x in the form that `lobpcg` needs: L has the constants in its null space and B is
/// diagonal. This process has some of the rows, or all rows.
class EigenProblem : public Polymorphic {
 public:
  /// @param size    rows of this process
  /// @param masses  the diagonal of B in these rows; empty if all are 1. Must outlive this object
  EigenProblem(Index size, std::span<const double> masses) : size_(size), masses_(masses) {}

  [[nodiscard]] Index size() const noexcept { return size_; }
  [[nodiscard]] double mass(Index v) const { return masses_.empty() ? 1.0 : masses_[v]; }

  /// Computes y = L x.
  virtual void apply(const VectorBlock<1>& x, VectorBlock<1>& y) const = 0;
  virtual void apply(const VectorBlock<2>& x, VectorBlock<2>& y) const = 0;
  /// Computes w ≈ L⁺ r.
  virtual void precondition(const VectorBlock<1>& r, VectorBlock<1>& w) = 0;
  virtual void precondition(const VectorBlock<2>& r, VectorBlock<2>& w) = 0;
  /// Returns whether the coarser graphs, on which `precondition` is based, may hide an eigenvector whose
  /// eigenvalue is smaller than `eigenvalue`. The result is the same on all processes.
  [[nodiscard]] virtual bool may_hide(double eigenvalue) const = 0;
  /// Adds up the sums of all processes, in place; all processes get the same result.
  virtual void add_up(std::span<double> sums) const = 0;

 private:
  Index size_;
  std::span<const double> masses_;
};

/// The problem on a level of a hierarchy, preconditioned by the hierarchy's cycle; B has the level's masses.
class LevelProblem : public EigenProblem {
 public:
  /// @param hierarchy  must outlive this object
  LevelProblem(const Hierarchy& hierarchy, int level)
      : EigenProblem(hierarchy.levels()[level].laplacian.size(), hierarchy.levels()[level].masses),
        hierarchy_(hierarchy),
        level_(level) {}

  void apply(const VectorBlock<1>& x, VectorBlock<1>& y) const override { laplacian().apply<1>(x, y); }
  void apply(const VectorBlock<2>& x, VectorBlock<2>& y) const override { laplacian().apply<2>(x, y); }
  void precondition(const VectorBlock<1>& r, VectorBlock<1>& w) override {
    hierarchy_.cycle<1>(level_, r, w, one_);
  }
  void precondition(const VectorBlock<2>& r, VectorBlock<2>& w) override {
    hierarchy_.cycle<2>(level_, r, w, two_);
  }
  [[nodiscard]] bool may_hide(double eigenvalue) const override {
    return hierarchy_.may_hide(level_, eigenvalue);
  }
  void add_up(std::span<double> /*sums*/) const override {}

 private:
  [[nodiscard]] const Laplacian& laplacian() const { return hierarchy_.levels()[level_].laplacian; }

  const Hierarchy& hierarchy_;
  int level_;
  CycleWorkspace<1> one_;
  CycleWorkspace<2> two_;
};

/// Improves the columns of `x` towards the eigenvectors of L x = λ B x with the smallest eigenvalues after
/// that of the constant vector.
///
/// Locally optimal block preconditioned conjugate gradients (Knyazev 2001): each iteration minimises the
/// Rayleigh quotient over the span of x, the preconditioned residuals, the previous directions, and
/// `companions`, all kept orthogonal to constants. Companions are rough guesses of the next eigenvectors. A
/// single column converges slowly if λ₃ is close to λ₂. A companion removes the column's part along the next
/// eigenvector, at far less cost than a second column. At the end, the columns are sorted by their
/// eigenvalues, ascending, and ‖x‖_B = 1. If a column of x is constant or depends on other columns, the
/// iteration replaces it by other vectors of the search space. O(graph) time for each iteration.
template <int M, int Companions>
LobpcgResult lobpcg(EigenProblem& problem, const LobpcgOptions& options, VectorBlock<M>& x,
                    VectorBlock<Companions> companions);

/// The same on one level of a hierarchy: see `LevelProblem`.
template <int M, int Companions>
LobpcgResult lobpcg(const Hierarchy& hierarchy, int level, const LobpcgOptions& options, VectorBlock<M>& x,
                    VectorBlock<Companions> companions);

/// The same without companions.
template <int M>
LobpcgResult lobpcg(const Hierarchy& hierarchy, int level, const LobpcgOptions& options, VectorBlock<M>& x) {
  return lobpcg<M, 0>(hierarchy, level, options, x, {});
}

}  // namespace meshorder
