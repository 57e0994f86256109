// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <vector>

namespace meshorder {

/// A square sparse matrix of numbers in compressed rows: both halves where it is symmetric. The columns of a
/// row rise, and the diagonal is among them.
struct SparseMatrix {
  std::vector<Offset> offsets{0};  ///< n + 1
  std::vector<Index> columns;
  std::vector<double> values;

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

}  // namespace meshorder
