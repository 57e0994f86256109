// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/multigrid/block_rows.hpp"

#include <vector>

namespace meshorder {

/// The blocks of each column of a prolongation: for offsets[a] ≤ k < offsets[a + 1], column a has block
/// `blocks[k]` in row `rows[k]`. The rows of a column are ascending.
struct ColumnBlocks {
  std::vector<Offset> offsets{0};
  std::vector<Index> rows;
  std::vector<Index> blocks;
};

/// Returns the blocks of each column. O(rows + columns + blocks).
template <int R>
ColumnBlocks column_blocks(const Prolongation<R>& prolongation);

/// Returns the pattern of Pᵀ A P, with its diagonal and ascending columns, without values. O(products of
/// blocks).
template <int R>
CoarseMatrix galerkin_pattern(const BlockView<R>& fine, const Prolongation<R>& p,
                              const ColumnBlocks& transposed);

/// Computes Pᵀ A P into the pattern of `coarse`, for symmetric A, in double. If an unknown has a column of
/// zeros in P, its diagonal entry becomes the largest diagonal entry of its block, or 1 if all are 0, so that
/// the product is definite if A is. O(multiplications), on all threads, with the same bits for any number of
/// threads.
template <int R>
void galerkin_product(const BlockView<R>& fine, const Prolongation<R>& p, const ColumnBlocks& transposed,
                      CoarseMatrix& coarse);

/// Compute the pattern, and the values, of (I − ω D⁻¹ A) P₀, where D is the block diagonal of A (Vaněk,
/// Mandel, Brezina 1996). `inverse_diagonal` holds the blocks of D⁻¹. O(multiplications).
Prolongation<kRigidModes> smoothed_pattern(const BlockView<kRigidModes>& matrix,
                                           const Prolongation<kRigidModes>& tentative);
void smooth_prolongation(const BlockView<kRigidModes>& matrix, std::span<const float> inverse_diagonal,
                         double omega, const Prolongation<kRigidModes>& tentative,
                         Prolongation<kRigidModes>& smoothed);

}  // namespace meshorder
