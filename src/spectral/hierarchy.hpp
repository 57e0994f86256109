// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/laplacian.hpp"
#include "spectral/aggregation.hpp"
#include "spectral/coarsening.hpp"
#include "spectral/row_chunks.hpp"

#include <Eigen/Core>

#include <vector>

namespace meshorder {

constexpr double kStrength = 0.1;      ///< of the strongest neighbour, on coarse levels
constexpr double kWorthwhile = 0.8;    ///< coarsening that keeps more vertices than this is given up
constexpr double kOverCorrection = 2;  ///< of plain coarsening; 1.5 to 3 serve as well

/// One graph of the hierarchy, and the way to the next coarser.
struct Level {
  Laplacian laplacian;
  RowChunks chunks;
  std::vector<double> masses;  ///< see `mass`; empty where all are 1
  Aggregation aggregation;     ///< makes the vertices of the next coarser level
  SparseRows prolongation;     ///< smoothed coarsening: the way from the next coarser level; else empty

  [[nodiscard]] bool is_smoothed() const { return prolongation.rows() > 0; }
  /// How many vertices of the finest graph v represents.
  [[nodiscard]] double mass(Index v) const { return masses.empty() ? 1.0 : masses[v]; }
};

/// Room for the vectors of a cycle on the levels below the one where it starts.
template <int M>
struct CycleWorkspace {
  struct OfLevel {
    VectorBlock<M> right_side, correction, second_correction;
  };
  std::vector<OfLevel> levels;
};

/// A hierarchy of ever coarser Laplacians of one connected graph, made by aggregation, with the cycle that
/// approximates the pseudo-inverse of the finest one.
///
/// The first coarsening is plain (piecewise constant prolongation), the later ones are smoothed aggregation
/// (Vaněk, Mandel, Brezina 1996): the finest operator keeps its sparsity where it costs most. Coarse
/// operators are Galerkin products Pᵀ L P. Memory: about 1.2 times the graph. Set-up: O(n + edges). Set-up
/// and cycles use all threads and give the same numbers on any number of them.
class Hierarchy {
 public:
  explicit Hierarchy(Laplacian finest);

  /// The same of a graph that is a coarse one itself: all coarsenings are smoothed.
  ///
  /// @param masses  of its vertices, > 0
  Hierarchy(Laplacian coarse, std::vector<double> masses);

  [[nodiscard]] const std::vector<Level>& levels() const noexcept { return levels_; }

  /// x ≈ L⁺ b on level `level` by one symmetric W-cycle: Gauss–Seidel forwards before and backwards after the
  /// coarse correction, which two cycles on the next level find; a small coarsest level is exact. Plain
  /// coarsening makes L too stiff for smooth vectors; its corrections are therefore made larger (Braess
  /// 1995). The columns of b must sum to 0.
  template <int M>
  void cycle(int level, const VectorBlock<M>& b, VectorBlock<M>& x, CycleWorkspace<M>& workspace) const;

  /// The same by two cycles, as the next finer level asks for it; by one where that is exact, and on the
  /// coarsest level. Leaves another vector in b.
  template <int M>
  void two_cycles(int level, VectorBlock<M>& b, VectorBlock<M>& x, VectorBlock<M>& second_x,
                  CycleWorkspace<M>& workspace) const;

  /// One Gauss–Seidel sweep forwards and one backwards on L x = 0: damps what prolongation left rough.
  template <int M>
  void smooth(int level, VectorBlock<M>& x) const;

  /// x += scale P y, from y on the next coarser level to x on `level`.
  template <int M>
  void add_prolonged(int level, double scale, const VectorBlock<M>& coarse, VectorBlock<M>& fine) const;

  /// The eigenvectors of L x = λ mass x on the coarsest level for the M smallest eigenvalues after that of
  /// the constant; columns that do not exist are 0. Only when `has_exact_coarsest`.
  template <int M>
  [[nodiscard]] VectorBlock<M> coarsest_eigenvectors() const;

  /// Whether coarsening came down to a graph that a dense solver takes.
  [[nodiscard]] bool has_exact_coarsest() const noexcept { return coarsest_inverse_.size() > 0; }

  /// Whether coarser levels may not show a vector with a smaller eigenvalue: an aggregate may hide it, see
  /// hiding.hpp, or there is no exact coarsest level. Up to 128 vertices the answer is exact; a finest level
  /// of up to 1,024 always may, as a search takes less than a millisecond there.
  [[nodiscard]] bool may_hide(int level, double eigenvalue) const;

 private:
  void coarsen_all(bool smoothed);

  std::vector<Level> levels_;
  Eigen::MatrixXd coarsest_inverse_;  ///< empty when the coarsest level is too large for it
};

}  // namespace meshorder
