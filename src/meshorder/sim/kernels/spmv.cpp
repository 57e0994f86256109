// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/sim/kernels/spmv.hpp>

#include <algorithm>

namespace meshorder {

template <class Value>
double multiply_rows_dot(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index begin_row, Index end_row) {
  const auto entries = 3 * static_cast<std::size_t>(matrix.size());
  if (x.size() != entries || y.size() != entries) {
    throw InvalidArgument("multiply: x and y must hold 3 doubles for each row of blocks");
  }
  const Value* const values = matrix.values.data();
  const Index* const columns = matrix.columns.data();
  // the entries of x that later rows gather are asked for early; nearer than this they come too late, and
  // much farther they are gone again
  constexpr Offset kAhead = 100;
  const Offset last_block = matrix.block_count() - 1;
  Offset k = matrix.offsets[begin_row];
  double dot = 0.0;
  for (Index v = begin_row; v < end_row; ++v) {
    // nine sums, since the additions of three would wait for each other
    double s[9] = {};
    for (const Offset end = matrix.offsets[v + 1]; k < end; ++k) {
      __builtin_prefetch(x.data() + Offset{3} * columns[std::min(k + kAhead, last_block)]);
      const Value* const block = values + 9 * k;
      const double* const p = x.data() + Offset{3} * columns[k];
      const double p0 = p[0], p1 = p[1], p2 = p[2];
      s[0] += block[0] * p0;
      s[1] += block[1] * p1;
      s[2] += block[2] * p2;
      s[3] += block[3] * p0;
      s[4] += block[4] * p1;
      s[5] += block[5] * p2;
      s[6] += block[6] * p0;
      s[7] += block[7] * p1;
      s[8] += block[8] * p2;
    }
    const double* const p = x.data() + Offset{3} * v;
    double* const q = y.data() + Offset{3} * v;
    q[0] = s[0] + s[1] + s[2];
    q[1] = s[3] + s[4] + s[5];
    q[2] = s[6] + s[7] + s[8];
    dot += p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  }
  return dot;
}

template <class Value>
void multiply_rows(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                   Index begin_row, Index end_row) {
  (void)multiply_rows_dot(matrix, x, y, begin_row, end_row);
}

template <class Value>
void multiply(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y) {
  multiply_rows(matrix, x, y, 0, matrix.size());
}

template void multiply(const BlockCsrOf<double>&, std::span<const double>, std::span<double>);
template void multiply(const BlockCsrOf<float>&, std::span<const double>, std::span<double>);
template void multiply_rows(const BlockCsrOf<double>&, std::span<const double>, std::span<double>, Index,
                            Index);
template void multiply_rows(const BlockCsrOf<float>&, std::span<const double>, std::span<double>, Index,
                            Index);
template double multiply_rows_dot(const BlockCsrOf<double>&, std::span<const double>, std::span<double>,
                                  Index, Index);
template double multiply_rows_dot(const BlockCsrOf<float>&, std::span<const double>, std::span<double>, Index,
                                  Index);

}  // namespace meshorder
