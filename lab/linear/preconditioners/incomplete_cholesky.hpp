// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"
#include "lab/linear/preconditioners/preconditioner.hpp"

#include <atomic>
#include <vector>

namespace meshorder {

/// A ≈ L D Lᵀ by 3×3 blocks in the pattern of A (Meijerink, van der Vorst 1977). L is unit lower triangular
/// and in float, which is accurate enough for an incomplete factor. If a pivot is not positive definite, the
/// diagonal blocks are enlarged and the factorisation restarts (Manteuffel 1980). Measured against Jacobi in
/// docs/evidence/benchmarks.md.
///
/// Vertices are eliminated in their order, except that vertices coupled to an earlier chunk of rows come
/// last. The inner vertices of different chunks are factored and solved on different threads. The chunks
/// depend on the pattern alone. In an order with short spans few vertices join chunks; in a scrambled order
/// most do, and threads gain nothing.
class IncompleteCholesky final : public Preconditioner {
 public:
  /// Copies the pattern of the matrices. Throws InvalidArgument when a row lacks its diagonal.
  explicit IncompleteCholesky(const BlockCsr& pattern);

  [[nodiscard]] std::size_t bytes() const override;

  /// Returns the relative enlargement of the diagonal blocks; 0 if none was needed.
  [[nodiscard]] double shift() const noexcept { return shift_; }

 private:
  /// O(blocks · row length).
  void take(const BlockCsr& matrix) override;
  void multiply(std::span<const double> r, std::span<double> z) const override;
  bool factor(const BlockCsr& matrix, double shift);
  void factor_rows(const BlockCsr& matrix, double shift, Index begin, Index end, std::atomic<bool>& definite);
  void keep_diagonal(const BlockCsr& matrix);
  /// Calls `work(begin, end)` for the inner rows of each chunk, on all threads.
  template <class Work>
  void for_each_inner_range(Work work) const;

  std::vector<Index> bounds_;       ///< of each chunk's inner rows; the other rows follow
  std::vector<Index> vertices_;     ///< the vertex of each row
  std::vector<Index> rows_;         ///< the row of each vertex
  std::vector<Offset> offsets_;     ///< of each row's blocks left of the diagonal
  std::vector<Index> columns_;      ///< the vertices of these blocks' columns, in the order of elimination
  std::vector<Offset> sources_;     ///< for each of these blocks, its index in the matrix
  std::vector<Offset> diagonals_;   ///< for each row, the index of its diagonal block in the matrix
  AlignedVector<float> values_;     ///< L's blocks, and one more number, since vector loads read past the end
  AlignedVector<double> inverses_;  ///< D⁻¹, 6 for each vertex: 00 01 02 11 12 22
  double shift_ = 0.0;
};

}  // namespace meshorder
