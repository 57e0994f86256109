// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/row_access.hpp"
#include "kernels/aligned.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace meshorder {

/// A sparse matrix of 3×3 blocks in compressed rows, one block row for each vertex: the stiffness matrix of a
/// mesh. The blocks of row v are `offsets[v] … offsets[v + 1] − 1`, with ascending columns that include the
/// diagonal. Block k holds `values[9 k] … values[9 k + 8]`, row by row. With its column a block takes 76
/// bytes in double, 40 in float.
template <class Value>
struct BlockCsrOf {
  std::vector<Offset> offsets{0};  ///< n + 1
  std::vector<Index> columns;
  AlignedVector<Value> values;

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] Offset block_count() const noexcept { return static_cast<Offset>(columns.size()); }
  void set_zero() { std::fill(values.begin(), values.end(), Value{0}); }

  /// Returns the index of the block in that row and column, −1 if the pattern has none. O(log row length).
  [[nodiscard]] Offset find(Index row, Index column) const {
    const Offset begin = offsets[row];
    const std::span<const Index> entries(columns.data() + begin, columns.data() + offsets[row + 1]);
    const Index place = entries_below(entries, column);
    return place < index_size(entries) && entries[place] == column ? begin + place : -1;
  }
};

using BlockCsr = BlockCsrOf<double>;

/// Returns the zero matrix with a block for every vertex and for both directions of every edge. O(n + edges).
BlockCsr zero_block_csr(const CsrGraph& graph);

/// Copies the matrix to `result`, whose memory is reused, and rounds the values to float. On all threads.
/// O(blocks).
void round_to_single(const BlockCsr& matrix, BlockCsrOf<float>& result);

/// Computes y = A x for a matrix in double or float; sums are in double. x and y hold 3 doubles for each
/// vertex and must not overlap. Throws InvalidArgument if a size differs. O(blocks); each block is read once,
/// so that memory bandwidth is the limit in a good order.
template <class Value>
void multiply(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y);

/// Computes only the rows begin_row … end_row − 1 of y = A x, with the same bits, so that threads can share
/// the rows.
template <class Value>
void multiply_rows(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                   Index begin_row, Index end_row);

/// Like `multiply_rows`; returns the part of xᵀA x that these rows contribute.
template <class Value>
double multiply_rows_dot(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index begin_row, Index end_row);

}  // namespace meshorder
