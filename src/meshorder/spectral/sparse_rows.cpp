// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/spectral/sparse_rows.hpp>

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

SparseRows product(const SparseRows& a, const SparseRows& b) {
  SparseRows result;
  result.columns_count = b.columns_count;
  result.offsets.reserve(a.offsets.size());
  // place_of[c]: where column c stands in the current row of the result, if at or after the row's start
  std::vector<Offset> place_of(b.columns_count, -1);
  for (Index row = 0; row < a.rows(); ++row) {
    const auto begin = static_cast<Offset>(result.columns.size());
    for (Offset k = a.offsets[row]; k < a.offsets[row + 1]; ++k) {
      for (Offset j = b.offsets[a.columns[k]]; j < b.offsets[a.columns[k] + 1]; ++j) {
        const Index column = b.columns[j];
        const double value = a.values[k] * b.values[j];
        if (place_of[column] >= begin) {
          result.values[place_of[column]] += value;
        } else {
          place_of[column] = static_cast<Offset>(result.columns.size());
          result.columns.push_back(column);
          result.values.push_back(value);
        }
      }
    }
    result.offsets.push_back(static_cast<Offset>(result.columns.size()));
  }
  return result;
}

}  // namespace meshorder
