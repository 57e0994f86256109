// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace meshorder {

/// Number of rigid motions in space: three translations and three rotations. They are the unknowns of a node
/// of a coarse level.
inline constexpr int kRigidModes = 6;

/// A sparse matrix of R×C blocks in compressed rows, each block row by row.
template <class Number, int R, int C>
struct BlockRows {
  static constexpr int kEntries = R * C;
  static constexpr int kRoom = 2;  ///< numbers past the last block that vector loads may touch

  Index columns_count = 0;
  std::vector<Offset> offsets{0};  ///< rows + 1
  std::vector<Index> columns;      ///< of a row, ascending
  std::vector<Number> values;      ///< in a Prolongation, `kRoom` more

  [[nodiscard]] Index rows() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] const Number* block(Offset k) const { return values.data() + kEntries * k; }
  [[nodiscard]] Number* block(Offset k) { return values.data() + kEntries * k; }
  [[nodiscard]] std::size_t bytes() const {
    return sizeof(Offset) * offsets.capacity() + sizeof(Index) * columns.capacity() +
           sizeof(Number) * values.capacity();
  }
};

/// Maps the rigid modes of coarse nodes to the R unknowns of each finer node.
template <int R>
using Prolongation = BlockRows<float, R, kRigidModes>;

/// The operator of a coarse level.
using CoarseMatrix = BlockRows<double, kRigidModes, kRigidModes>;

/// A reordered view of a square matrix of R×R blocks: row i of the view is row `order[i]` of the matrix, and
/// column j of the matrix is column `number[j]` of the view.
template <int R>
struct BlockView {
  std::span<const Offset> offsets;
  std::span<const Index> columns;
  std::span<const double> values;  ///< each block row by row
  std::span<const Index> order;
  std::span<const Index> number;

  [[nodiscard]] Index rows() const noexcept { return static_cast<Index>(order.size()); }
  /// Calls `take(column, block)` for the blocks of row i, in the order in which they are stored.
  template <class Take>
  void for_each_in_row(Index i, Take take) const {
    const Index row = order[i];
    for (Offset k = offsets[row]; k < offsets[row + 1]; ++k) {
      take(number[columns[k]], values.data() + Offset{R * R} * k);
    }
  }
};

}  // namespace meshorder
