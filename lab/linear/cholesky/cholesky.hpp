// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "lab/linear/cholesky/ldl.hpp"
#include "lab/linear/cholesky/panel_factor.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace meshorder {

/// The part of the factor needed for right-hand sides that are 0 except at some vertices: the columns on the
/// vertices' paths to the roots of the elimination tree (Gilbert 1994), as panels.
struct FactorReach {
  std::vector<Index> vertices;  ///< as given to reach_of
  std::vector<Index> panels;    ///< ascending
  Offset entries = 0;           ///< number of entries in these panels
};

/// The Cholesky factor L D Lᵀ of a symmetric positive definite matrix A. Solves A X = B for all coordinates
/// of the vertices at once. The factor has a fill-reducing order of its own (nested dissection); vectors are
/// in the order of the matrix. `Real` is the precision of the factor and of vectors, double or float; the
/// factor is computed in double. Solves run on all threads, with the same bits for any number of threads.
/// `solve` and `reach_of` use scratch memory of the factor: only one thread may call them at a time.
template <class Real>
class CholeskyFactor {
 public:
  /// Reads the upper half of the matrix. Throws as factor_ldl does, for example InvalidArgument for a matrix
  /// that is not positive definite. O(n^3/2) operations for meshes in the plane, O(n²) in space.
  explicit CholeskyFactor(const SparseMatrix& matrix) : CholeskyFactor(factor_ldl(matrix)) {}

  /// Computes x = A⁻¹ b. Both vectors have kPaddedStride numbers for each vertex (see padded_positions); the
  /// last number of each vertex is 0. b and x may be the same array, but must not overlap otherwise. Throws
  /// InvalidArgument for other sizes. O(entries).
  void solve(std::span<const Real> b, std::span<Real> x) const;

  /// Returns the part of the factor needed for right-hand sides that are 0 except at these vertices, if
  /// solutions are wanted only there. The vertices may be in any order and repeat. Throws InvalidArgument for
  /// a vertex that does not exist. O(panels reached, times the logarithm of their number).
  [[nodiscard]] FactorReach reach_of(std::span<const Index> vertices) const;

  /// Computes x = A⁻¹ b at the vertices given to reach_of; b must be 0 at all other vertices. b and x have
  /// their full size, but only the numbers of these vertices are read and written. b and x may be the same
  /// array. O(reach.entries).
  void solve(const FactorReach& reach, std::span<const Real> b, std::span<Real> x) const;

  [[nodiscard]] Index size() const noexcept { return panels_.size(); }
  /// Returns the number of entries in the pattern of L, diagonal included.
  [[nodiscard]] Offset entries() const noexcept { return entries_; }
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const { return panels_.bytes(); }

 private:
  explicit CholeskyFactor(const Ldl& ldl);
  void check_sizes(std::span<const Real> b, std::span<Real> x) const;

  PanelFactor<Real> panels_;
  Offset entries_;
  mutable AlignedVector<Real> work_;   ///< kPaddedStride numbers for each place
  mutable std::vector<Index> marked_;  ///< for each panel, the number of the last search that reached it
  mutable Index searches_ = 0;
};

}  // namespace meshorder
