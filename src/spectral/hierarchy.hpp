// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/laplacian.hpp"
#include "spectral/aggregation.hpp"
#include "spectral/coarsening.hpp"
#include "spectral/row_chunks.hpp"

#include <Eigen/Core>

#include <vector>

namespace meshorder {

constexpr double kStrength = 0.1;      ///< `strength` of `aggregate` on all levels
constexpr double kWorthwhile = 0.8;    ///< coarsening that keeps a larger share of the vertices is given up
constexpr double kOverCorrection = 2;  ///< factor on plain corrections; 1.5 to 3 are equally good

/// One graph of the hierarchy, and the transfer to the next coarser one.
struct Level {
  Laplacian laplacian;
  RowChunks chunks;
  std::vector<double> masses;  ///< see `mass`; empty if all are 1
  Aggregation aggregation;     ///< its aggregates are the vertices of the next coarser level
  SparseRows prolongation;     ///< from the next coarser level if coarsening is smoothed; else empty

  [[nodiscard]] bool is_smoothed() const { return prolongation.rows() > 0; }
  /// Returns how many vertices of the finest graph v represents.
  [[nodiscard]] double mass(Index v) const { return masses.empty() ? 1.0 : masses[v]; }
};

/// Memory for the vectors of a cycle on all levels that are coarser than the level where the cycle starts.
template <int M>
struct CycleWorkspace {
  struct OfLevel {
    VectorBlock<M> right_side, correction, second_correction;
  };
  std::vector<OfLevel> levels;
};

/// A hierarchy of ever coarser Laplacians of one connected graph, made by aggregation, with the cycle that
/// approximates the pseudo-inverse of the finest Laplacian.
///
/// The first coarsening is plain (piecewise constant prolongation): the largest coarse operator stays sparse.
/// The later coarsenings are by smoothed aggregation (Vaněk, Mandel, Brezina 1996). Coarsening and cycles use
/// all threads and give the same numbers on any number of threads.
class Hierarchy {
 public:
  explicit Hierarchy(Laplacian finest);

  /// Makes a hierarchy for a graph that is itself the result of coarsening: all further coarsenings are
  /// smoothed.
  ///
  /// @param masses  masses of the vertices, > 0
  Hierarchy(Laplacian coarse, std::vector<double> masses);

  [[nodiscard]] const std::vector<Level>& levels() const noexcept { return levels_; }

  /// Computes x ≈ L⁺ b on level `level` by one symmetric W-cycle: a Gauss–Seidel sweep forwards, the coarse
  /// correction, and a Gauss–Seidel sweep backwards. The coarse correction comes from two cycles on the next
  /// level; a small coarsest level is solved exactly. Plain coarsening makes L too stiff for smooth vectors,
  /// so plain corrections are enlarged (Braess 1995). Each column of b must sum to 0.
  template <int M>
  void cycle(int level, const VectorBlock<M>& b, VectorBlock<M>& x, CycleWorkspace<M>& workspace) const;

  /// The same by two cycles, or by one on the coarsest level. The result is to be added to the finer level's
  /// x. May overwrite b.
  template <int M>
  void two_cycles(int level, VectorBlock<M>& b, VectorBlock<M>& x, VectorBlock<M>& second_x,
                  CycleWorkspace<M>& workspace) const;

  /// Does one Gauss–Seidel sweep forwards and one backwards on L x = 0: damps the rough parts that
  /// prolongation leaves.
  template <int M>
  void smooth(int level, VectorBlock<M>& x) const;

  /// Adds scale · P · `coarse` to `fine`. `fine` is on `level`, `coarse` on the next coarser level.
  template <int M>
  void add_prolonged(int level, double scale, const VectorBlock<M>& coarse, VectorBlock<M>& fine) const;

  /// Returns the eigenvectors of L x = λ mass x on the coarsest level for the M smallest eigenvalues after
  /// that of the constant vector. Columns for which there is no eigenvector are 0. Must be called only if
  /// `has_exact_coarsest`.
  template <int M>
  [[nodiscard]] VectorBlock<M> coarsest_eigenvectors() const;

  /// Returns whether the coarsest graph is small enough for a dense solver.
  [[nodiscard]] bool has_exact_coarsest() const noexcept { return coarsest_inverse_.size() > 0; }

  /// Returns whether coarser levels may fail to show a vector with a smaller eigenvalue: an aggregate may
  /// hide it (see hiding.hpp), or there is no exact coarsest level. For up to 128 vertices the answer comes
  /// from pivots. For a finest level of 129 to 1,024 vertices the answer is always true, because a search
  /// then takes less than a millisecond.
  [[nodiscard]] bool may_hide(int level, double eigenvalue) const;

 private:
  void coarsen_all(bool smoothed);

  std::vector<Level> levels_;
  Eigen::MatrixXd coarsest_inverse_;  ///< empty if the coarsest level is too large for a dense inverse
};

}  // namespace meshorder
