// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/laplacian.hpp"
#include "spectral/aggregation.hpp"
#include "spectral/coarsening.hpp"
#include "spectral/row_chunks.hpp"

#include <Eigen/Core>

#include <vector>

namespace meshorder {

constexpr double kStrength = 0.1;      ///< relative to the strongest neighbour, on coarse levels
constexpr double kWorthwhile = 0.8;    ///< coarsening that keeps a larger share of the vertices is given up
constexpr double kOverCorrection = 2;  ///< of plain coarsening; 1.5 to 3 serve as well

/// One graph of the hierarchy, and the transfer to the next coarser one.
struct Level {
  Laplacian laplacian;
  RowChunks chunks;
  std::vector<double> masses;  ///< see `mass`; empty where all are 1
  Aggregation aggregation;     ///< its aggregates are the vertices of the next coarser level
  SparseRows prolongation;     ///< for smoothed coarsening, from the next coarser level; else empty

  [[nodiscard]] bool is_smoothed() const { return prolongation.rows() > 0; }
  /// Returns how many vertices of the finest graph v represents.
  [[nodiscard]] double mass(Index v) const { return masses.empty() ? 1.0 : masses[v]; }
};

/// Memory for the vectors of a cycle on the levels coarser than the one where it starts.
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
/// The first coarsening is plain (piecewise constant prolongation): the largest coarse operator stays sparse.
/// The later ones are smoothed aggregation (Vaněk, Mandel, Brezina 1996). Coarse
/// and cycles use all threads and give the same numbers on any number of them.
class Hierarchy {
 public:
  explicit Hierarchy(Laplacian finest);

  /// Makes a hierarchy for a graph that is a coarse one itself: all coarsenings are smoothed.
  ///
  /// @param masses  of its vertices, > 0
  Hierarchy(Laplacian coarse, std::vector<double> masses);

  [[nodiscard]] const std::vector<Level>& levels() const noexcept { return levels_; }

  /// Computes x ≈ L⁺ b on level `level` by one symmetric W-cycle: Gauss–Seidel forwards before and backwards
  /// after the coarse correction, which comes from two cycles on the next level; a small coarsest level is
  /// solved exactly. Plain coarsening makes L too stiff for smooth vectors, so its corrections are made
  /// larger (Braess 1995). The columns of b must sum to 0.
  template <int M>
  void cycle(int level, const VectorBlock<M>& b, VectorBlock<M>& x, CycleWorkspace<M>& workspace) const;

  /// Does the same by two cycles, as the next finer level needs it; on the coarsest level, by one. Overwrites
  /// b with another vector.
  template <int M>
  void two_cycles(int level, VectorBlock<M>& b, VectorBlock<M>& x, VectorBlock<M>& second_x,
                  CycleWorkspace<M>& workspace) const;

  /// Does one Gauss–Seidel sweep forwards and one backwards on L x = 0: damps the rough parts that
  /// prolongation leaves.
  template <int M>
  void smooth(int level, VectorBlock<M>& x) const;

  /// Adds scale P y to x, with y on the next coarser level and x on `level`.
  template <int M>
  void add_prolonged(int level, double scale, const VectorBlock<M>& coarse, VectorBlock<M>& fine) const;

  /// Returns the eigenvectors of L x = λ mass x on the coarsest level for the M smallest eigenvalues after
  /// that of the constant; columns that do not exist are 0. Only if `has_exact_coarsest`.
  template <int M>
  [[nodiscard]] VectorBlock<M> coarsest_eigenvectors() const;

  /// Returns whether the coarsest graph is small enough for a dense solver.
  [[nodiscard]] bool has_exact_coarsest() const noexcept { return coarsest_inverse_.size() > 0; }

  /// Returns whether coarser levels may fail to show a vector with a smaller eigenvalue: an aggregate may
  /// hide it, see hiding.hpp, or there is no exact coarsest level. Up to 128 vertices the answer comes from
  /// pivots; for a finest level of up to 1,024 it is true, as a search takes less than a millisecond there.
  [[nodiscard]] bool may_hide(int level, double eigenvalue) const;

 private:
  void coarsen_all(bool smoothed);

  std::vector<Level> levels_;
  Eigen::MatrixXd coarsest_inverse_;  ///< empty if the coarsest level is too large for it
};

}  // namespace meshorder
