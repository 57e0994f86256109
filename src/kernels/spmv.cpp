// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/block_csr.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/spmv.cpp"
#include <hwy/foreach_target.h>
// the rest of this file is compiled once for each instruction set
#include "kernels/block_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

// number of blocks between the block in use and the one prefetched
constexpr Offset kAhead = 128;

/// Computes the rows begin … end − 1; returns their part of xᵀA x. With `Blocks` it prefetches the blocks,
/// with `Gather` the entries of x. With `Gather`, at least kAhead blocks must follow row end − 1.
template <bool Blocks, bool Gather, class Value>
double product_rows(const BlockCsrOf<Value>& matrix, const double* x, double* y, Index begin, Index end) {
  const Value* const values = matrix.values.data();
  const Index* const columns = matrix.columns.data();
  Offset k = matrix.offsets[begin];
  double dot = 0.0;
  for (Index v = begin; v < end; ++v) {
    RowSums sums;
    for (const Offset row_end = matrix.offsets[v + 1]; k < row_end; ++k) {
      if constexpr (Blocks) __builtin_prefetch(values + 9 * (k + kAhead));
      if constexpr (Gather) __builtin_prefetch(x + Offset{3} * columns[k + kAhead]);
      sums.add(values + 9 * k, x + Offset{3} * columns[k]);
    }
    const double* const p = x + Offset{3} * v;
    double* const q = y + Offset{3} * v;
    sums.store(q);
    dot += p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  }
  return dot;
}

template <bool Blocks, class Value>
double product(const BlockCsrOf<Value>& matrix, const double* x, double* y, Index begin, Index end) {
  // a vector that fits into the second-level cache needs no prefetch
  constexpr Index kNearVertices = (Index{3} << 20) / (2 * 3 * sizeof(double));
  if (matrix.size() <= kNearVertices) return product_rows<Blocks, false>(matrix, x, y, begin, end);
  const auto row_ends = matrix.offsets.begin() + 1;
  const auto followed = static_cast<Index>(
      std::upper_bound(row_ends + begin, row_ends + end, matrix.block_count() - kAhead) - row_ends);
  return product_rows<Blocks, true>(matrix, x, y, begin, followed) +
         product_rows<Blocks, false>(matrix, x, y, followed, end);
}

double product_of_doubles(const BlockCsrOf<double>& matrix, const double* x, double* y, Index begin,
                          Index end) {
  return product<true>(matrix, x, y, begin, end);
}

double product_of_streamed_doubles(const BlockCsrOf<double>& matrix, const double* x, double* y, Index begin,
                                   Index end) {
  return product<false>(matrix, x, y, begin, end);
}

double product_of_floats(const BlockCsrOf<float>& matrix, const double* x, double* y, Index begin,
                         Index end) {
  return product<true>(matrix, x, y, begin, end);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/host.hpp"
#include "kernels/simd_dispatch.hpp"

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(product_of_doubles);
MESHORDER_SIMD_VERSIONS(product_of_streamed_doubles);
MESHORDER_SIMD_VERSIONS(product_of_floats);

/// Returns whether the processor is known to read blocks of doubles faster without prefetches. This is true
/// of Zen 4 and false of Zen 3; other processors were not measured (docs/evidence/benchmarks.md, What the
/// product asks for).
bool streams_by_itself() {
  static const bool result = is_zen4(family_of_this_machine());
  return result;
}

}  // namespace

template <class Value>
double multiply_rows_dot(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index begin_row, Index end_row) {
  const auto entries = 3 * static_cast<std::size_t>(matrix.size());
  if (x.size() != entries || y.size() != entries) {
    throw InvalidArgument("multiply: x and y must hold 3 doubles for each row of blocks");
  }
  if constexpr (std::is_same_v<Value, double>) {
    if (streams_by_itself()) {
      return MESHORDER_SIMD(product_of_streamed_doubles)(matrix, x.data(), y.data(), begin_row, end_row);
    }
    return MESHORDER_SIMD(product_of_doubles)(matrix, x.data(), y.data(), begin_row, end_row);
  } else {
    return MESHORDER_SIMD(product_of_floats)(matrix, x.data(), y.data(), begin_row, end_row);
  }
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
#endif
