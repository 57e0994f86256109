// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"
#include "lab/linear/multigrid/block_rows.hpp"
#include "spectral/row_chunks.hpp"

#include <cstddef>
#include <vector>

namespace meshorder {

/// Floats from one node to the next in the vectors of a level with R unknowns a node. The floats after the
/// unknowns stay 0.
template <int R>
inline constexpr Index kNodeStride = R == 3 ? 4 : 8;

struct SweptRows;

/// Gauss–Seidel by blocks on a symmetric matrix A = L + D + Lᵀ of R×R blocks. Only L and the inverse blocks
/// of D are kept, in float. L serves both triangles: a sweep that reads a row of L also adds the row's part
/// of Lᵀ x to earlier rows.
///
/// Rows are processed in chunks. Chunks of one colour are processed at the same time (see RowChunks); every
/// chunk touches only adjacent chunks. L couples a row to rows that a forward sweep processes earlier.
/// Results have the same bits for any number of threads.
template <int R>
class BlockSweeps {
 public:
  static constexpr Index kMinRows = 512;  ///< fewer rows are not worth a task

  BlockSweeps() = default;

  /// Takes the pattern of A; the values follow by `update`. Chunks have at least `min_rows` rows.
  explicit BlockSweeps(const BlockView<R>& pattern, Index min_rows = kMinRows);

  /// Takes the values, on all threads. Diagonal blocks that are not positive definite are made positive
  /// definite.
  void update(const BlockView<R>& matrix);

  /// Scratch memory for contributions of rows to earlier rows: two vectors of kNodeStride floats a node.
  struct Given {
    AlignedVector<float> from_below, from_above;
  };

  /// Computes x = (L + D)⁻¹ b, and residual = b − A x = −Lᵀ x.
  void forwards(const AlignedVector<float>& b, AlignedVector<float>& x, AlignedVector<float>& residual,
                Given& given) const;

  /// Replaces x by (D + Lᵀ)⁻¹ (b − L x).
  void backwards(const AlignedVector<float>& b, AlignedVector<float>& x, Given& given) const;

  /// Computes residual = L (before − x), which is b − A x if `backwards` turned `before` into x.
  void residual_after_backwards(const AlignedVector<float>& before, const AlignedVector<float>& x,
                                AlignedVector<float>& residual) const;

  [[nodiscard]] Index rows() const noexcept { return index_size(offsets_) - 1; }
  /// Returns the blocks of D⁻¹, each column by column.
  [[nodiscard]] const AlignedVector<float>& inverse_diagonal() const noexcept { return inverse_diagonal_; }
  [[nodiscard]] const RowChunks& chunks() const noexcept { return chunks_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  void clear(Given& given) const;
  [[nodiscard]] SweptRows rows_swept(Index begin, Index end, const float* b, float* x, Given* given) const;

  RowChunks chunks_;
  std::vector<Offset> offsets_{0};  ///< of the rows of L
  std::vector<Index> columns_;
  std::vector<Index> sources_;   ///< of each block of L: the index of its transpose in the matrix
  AlignedVector<float> values_;  ///< blocks column by column, and room for a load past the last block
  AlignedVector<float> inverse_diagonal_;
};

}  // namespace meshorder
