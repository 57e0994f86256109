// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/block_csr.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// A symmetric matrix of 3×3 blocks that stores most pairs of mirrored blocks once. The rows are cut into
/// slabs of about equal numbers of blocks. A block is stored in its row if it is on the diagonal, or if its
/// row and column are in different slabs. Of two blocks that mirror each other within a slab, only the block
/// above the diagonal is stored; it is used in both rows. The product of a slab therefore writes only to the
/// slab's own rows: threads take slabs, without atomics or a second pass, and every sum has its terms in the
/// same sequence for any number of threads. In a poor order most blocks are between slabs, and nearly the
/// full matrix is stored.
///
/// Block k holds `values[9 k] … values[9 k + 8]`, row by row. Of row v, blocks `offsets[2 v] … offsets[2 v +
/// 1] − 1` are used in row v only, blocks `offsets[2 v + 1] … offsets[2 v + 2] − 1` also in the row of their
/// column. Columns ascend in both parts. With its column a block takes 76 bytes in double, 40 in float.
template <class Value>
struct HalfBlockCsrOf {
  std::vector<Index> slabs{0};     ///< bounds of the slabs
  std::vector<Offset> offsets{0};  ///< 2 n + 1
  std::vector<Index> columns;      ///< one per block, then kSpareColumns zeros: columns are read ahead
  AlignedVector<Value> values;     ///< 9 per block, then a zero: vector loads read past the blocks

  static constexpr Offset kSpareColumns = 64;

  [[nodiscard]] Index size() const noexcept { return slabs.back(); }
  [[nodiscard]] Index slab_count() const noexcept { return static_cast<Index>(slabs.size()) - 1; }
  /// Returns the number of stored blocks.
  [[nodiscard]] Offset block_count() const noexcept { return offsets.back(); }
};

using HalfBlockCsr = HalfBlockCsrOf<double>;

/// Returns the bounds of the slabs of a matrix: 16 slabs, or one per row if there are fewer rows. O(log n).
std::vector<Index> slabs_of(const BlockCsr& matrix);

/// Returns the share, 0 … 1, of a matrix's blocks whose row and column are in different slabs; such a block
/// and its mirror image are both stored. O(blocks) time; reads only the columns.
double share_between_slabs(const BlockCsr& matrix);

/// Copies a matrix to `result`, whose memory is reused; rounds the values if Value is float. The matrix and
/// its pattern must be symmetric to the last bit: blocks below the diagonal within a slab are not read. On
/// all threads. O(blocks).
template <class Value>
void store_half(const BlockCsr& matrix, HalfBlockCsrOf<Value>& result);

/// Computes y = A x for the rows of one slab; returns their part of xᵀA x. x and y hold 3 doubles for each
/// vertex and must not overlap; all of x is read. All sums are in double, even if the matrix is in float.
/// Products with a block are rounded as with the full matrix, but added in another sequence. Throws
/// InvalidArgument if a size differs. O(blocks).
template <class Value>
double multiply_slab_dot(const HalfBlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index slab);

/// Computes y = A x on all threads, with the same bits for any number of them.
template <class Value>
void multiply(const HalfBlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y);

/// Returns whether repeated products with a symmetric matrix of this pattern are expected to be faster with
/// half of it stored (see HalfBlockCsr): the matrix must take 4 MiB or more, too much for a core's own
/// caches, and less than half of its blocks may be between slabs. The answer is the same on every machine. It
/// comes from the measurements in docs/evidence/benchmarks.md. O(blocks); reads only the columns.
bool half_storage_pays(const BlockCsr& matrix);

}  // namespace meshorder
