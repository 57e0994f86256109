// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/sparse_rows.hpp"

#include <numeric>

namespace meshorder {

SparseRows transposed(const SparseRows& a) {
  SparseRows result;
  result.columns_count = a.rows();
  result.offsets.assign(Offset{a.columns_count} + 1, 0);
  for (const Index column : a.columns) ++result.offsets[column + 1];
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.columns.resize(a.columns.size());
  result.values.resize(a.values.size());
  std::vector<Offset> next(result.offsets.begin(), result.offsets.end() - 1);
  for (Index row = 0; row < a.rows(); ++row) {
    for (Offset k = a.offsets[row]; k < a.offsets[row + 1]; ++k) {
      const Offset place = next[a.columns[k]]++;
      result.columns[place] = row;
      result.values[place] = a.values[k];
    }
  }
  return result;
}

}  // namespace meshorder
