// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <vector>

namespace meshorder {

/// A square sparse matrix in compressed rows, with both halves if it is symmetric. The columns of a row are
/// ascending and include the diagonal.
struct SparseMatrix {
  std::vector<Offset> offsets{0};  ///< n + 1
  std::vector<Index> columns;
  std::vector<double> values;

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

/// The factors of P A Pᵀ = L D Lᵀ. L is unit lower triangular, by columns.
struct Ldl {
  std::vector<Index> new_to_old;   ///< row i of L is row new_to_old[i] of A
  std::vector<Offset> offsets{0};  ///< of the columns of L, without the diagonal, n + 1
  std::vector<Index> rows;         ///< ascending in a column
  std::vector<double> values;
  std::vector<double> pivots;  ///< D, positive

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

/// Factors a symmetric positive definite matrix in an order that keeps L sparse: nested dissection (George
/// 1973), by METIS and CHOLMOD (Chen, Davis, Hager, Rajamanickam 2008). Reads the upper half. The factor is
/// the same on every run. Throws InvalidArgument if a pivot is negative or 0 up to rounding errors (and names
/// the row), and if 32 bits cannot count the entries. For meshes, L has O(n log n) entries in the plane and
/// O(n^4/3) in space.
Ldl factor_ldl(const SparseMatrix& matrix);

}  // namespace meshorder
