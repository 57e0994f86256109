// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <vector>

namespace meshorder {

/// A sparse matrix by rows; the columns of a row are in no particular order, none twice.
struct SparseRows {
  Index columns_count = 0;
  std::vector<Offset> offsets{0};  ///< rows + 1
  std::vector<Index> columns;
  std::vector<double> values;

  [[nodiscard]] Index rows() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

/// Aᵀ. O(rows + columns + entries).
SparseRows transposed(const SparseRows& a);

}  // namespace meshorder
