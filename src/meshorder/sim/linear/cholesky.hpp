// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/sim/kernels/aligned.hpp>
#include <meshorder/sim/linear/sparse_matrix.hpp>

#include <memory>
#include <span>
#include <vector>

namespace meshorder {

/// The Cholesky factor of a symmetric positive definite matrix, which solves A X = B for the coordinates of
/// all vertices at once. The factor's own fill-reducing order (nested dissection) is its own affair: vectors
/// have the order of the matrix. `Real` is the precision of the factor and of vectors, double or float; the
/// factor is computed in double. The same bits on every run and for any number of threads.
template <class Real>
class CholeskyFactor {
 public:
  /// Throws InvalidArgument for a matrix that is not positive definite, with the row where that shows.
  explicit CholeskyFactor(const SparseMatrix& matrix);

  /// x = A⁻¹ b, kPaddedStride numbers for each vertex (see padded_positions) of which the last is 0 in both.
  /// They may be the same array. O(entries).
  void solve(std::span<const Real> b, std::span<Real> x) const;

  /// What right-hand sides that vanish outside of some vertices see of the factor, where solutions are wanted
  /// at these vertices alone: the columns on their paths to the root of the elimination tree (Gilbert 1994).
  struct Reach {
    std::vector<Index> columns;  ///< of the factor, rising
  };
  [[nodiscard]] Reach reach_of(std::span<const Index> vertices) const;

  /// The same solution at the vertices of `reach`, where b may be other than 0; elsewhere x is not touched
  /// and b is not read. O(entries of the reach).
  void solve(const Reach& reach, std::span<const Real> b, std::span<Real> x) const;

  [[nodiscard]] Index size() const noexcept;
  /// Entries of the factor, diagonal included.
  [[nodiscard]] Offset entries() const noexcept;
  /// Memory held.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Factor;
  std::shared_ptr<const Factor> factor_;
};

}  // namespace meshorder
