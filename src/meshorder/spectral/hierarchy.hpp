// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/graph/laplacian.hpp>
#include <meshorder/spectral/sparse_rows.hpp>

#include <Eigen/Dense>

#include <vector>

namespace meshorder {

/// One graph of the hierarchy, and the way to the next coarser.
struct Level {
  Laplacian laplacian;
  std::vector<double> mass;         ///< how many vertices of the finest graph each stands for
  std::vector<Index> aggregate_of;  ///< plain coarsening: the coarser vertex of each vertex
  SparseRows prolongation;          ///< smoothed coarsening: the way from the next coarser level
};

/// A hierarchy of ever coarser Laplacians of one connected graph, made by aggregation, with the V-cycle that
/// approximates the pseudo-inverse of the finest one.
///
/// The first coarsening is plain (piecewise constant prolongation), the later ones are smoothed aggregation
/// (Vaněk, Mandel, Brezina 1996): the finest operator keeps its sparsity where it costs most. Coarse
/// operators are Galerkin products Pᵀ L P. Memory: about 1.5 times the graph. Set-up: O(n + edges).
class Hierarchy {
 public:
  explicit Hierarchy(Laplacian finest);

  [[nodiscard]] const std::vector<Level>& levels() const noexcept { return levels_; }

  /// x ≈ L⁺ b on level `level` by one symmetric V-cycle: Gauss–Seidel forwards before and backwards after the
  /// coarse correction, the coarsest level exactly. The columns of b must sum to 0.
  template <int M>
  void v_cycle(int level, const VectorBlock<M>& b, VectorBlock<M>& x) const;

  /// x += P y, from y on the next coarser level to x on `level`.
  template <int M>
  void add_prolonged(int level, const VectorBlock<M>& coarse, VectorBlock<M>& fine) const;

  /// The eigenvectors of L x = λ mass x on the coarsest level for the M smallest eigenvalues after that of
  /// the constant; columns that do not exist are 0. Only when `has_exact_coarsest`.
  template <int M>
  [[nodiscard]] VectorBlock<M> coarsest_eigenvectors() const;

  /// Whether coarsening came down to a graph that a dense solver takes.
  [[nodiscard]] bool has_exact_coarsest() const noexcept { return coarsest_inverse_.size() > 0; }

 private:
  std::vector<Level> levels_;
  Eigen::MatrixXd coarsest_inverse_;  ///< empty when the coarsest level is too large for it
};

}  // namespace meshorder
