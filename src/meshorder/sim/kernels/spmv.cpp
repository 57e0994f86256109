// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/sim/kernels/spmv.hpp>

#include <algorithm>
#include <cstdint>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "meshorder/sim/kernels/spmv.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_MAX_BYTES >= 32
/// The sums of a row's blocks times the vector: each of a block's nine products by itself, since the
/// additions of three would wait for each other; the first eight in vectors.
struct RowSums {
  using Tag = hn::CappedTag<double, 8>;
  static constexpr int kLanes = static_cast<int>(MaxLanes(Tag()));
  static constexpr int kVectors = 8 / kLanes;
  hn::Vec<Tag> sums[kVectors];
  double last = 0.0;

  HWY_INLINE RowSums() {
    for (auto& sum : sums) sum = hn::Zero(Tag());
  }

  template <class Value>
  HWY_INLINE void add(const Value* block, const double* p) {
    // p₀ p₁ p₁ p₂, since behind p₂ nothing may be read
    const hn::FixedTag<double, 2> two;
    const hn::FixedTag<double, 4> four;
    const auto p0112 = hn::Combine(four, hn::LoadU(two, p + 1), hn::LoadU(two, p));
    alignas(64) constexpr std::int64_t kPlaces[8] = {0, 1, 3, 0, 1, 3, 0, 1};
    const Tag d;
    for (int i = 0; i < kVectors; ++i) {
      const auto places = hn::SetTableIndices(d, kPlaces + i * kLanes);
      sums[i] = hn::MulAdd(load(block + i * kLanes), hn::TableLookupLanes(widened(p0112), places), sums[i]);
    }
    last += block[8] * p[2];
  }

  HWY_INLINE void store(double* q) const {
    alignas(64) double s[8];
    for (int i = 0; i < kVectors; ++i) hn::Store(sums[i], Tag(), s + i * kLanes);
    q[0] = s[0] + s[1] + s[2];
    q[1] = s[3] + s[4] + s[5];
    q[2] = s[6] + s[7] + last;
  }

 private:
  static HWY_INLINE hn::Vec<Tag> load(const double* values) { return hn::LoadU(Tag(), values); }
  static HWY_INLINE hn::Vec<Tag> load(const float* values) {
    return hn::PromoteTo(Tag(), hn::LoadU(hn::Rebind<float, Tag>(), values));
  }
  template <class Four>
  static HWY_INLINE hn::Vec<Tag> widened(Four four) {
    if constexpr (kLanes == 4) {
      return four;
    } else {
      return hn::ZeroExtendVector(Tag(), four);
    }
  }
};
#else
/// The same one product at a time: two lanes gain nothing.
struct RowSums {
  double s[9] = {};

  template <class Value>
  HWY_INLINE void add(const Value* block, const double* p) {
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

  HWY_INLINE void store(double* q) const {
    q[0] = s[0] + s[1] + s[2];
    q[1] = s[3] + s[4] + s[5];
    q[2] = s[6] + s[7] + s[8];
  }
};
#endif

// blocks from a request to its use: the processor by itself looks less far ahead
constexpr Offset kAhead = 128;

/// With `kGather` the entries of x are asked for early too: kAhead blocks must follow the last row.
template <bool kGather, class Value>
double product_rows(const BlockCsrOf<Value>& matrix, const double* x, double* y, Index begin, Index end) {
  const Value* const values = matrix.values.data();
  const Index* const columns = matrix.columns.data();
  Offset k = matrix.offsets[begin];
  double dot = 0.0;
  for (Index v = begin; v < end; ++v) {
    RowSums sums;
    for (const Offset row_end = matrix.offsets[v + 1]; k < row_end; ++k) {
      __builtin_prefetch(values + 9 * (k + kAhead));
      if (kGather) __builtin_prefetch(x + Offset{3} * columns[k + kAhead]);
      sums.add(values + 9 * k, x + Offset{3} * columns[k]);
    }
    const double* const p = x + Offset{3} * v;
    double* const q = y + Offset{3} * v;
    sums.store(q);
    dot += p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  }
  return dot;
}

template <class Value>
double product(const BlockCsrOf<Value>& matrix, const double* x, double* y, Index begin, Index end) {
  // a vector that the second-level cache holds needs no requests
  constexpr Index kNearVertices = (Index{3} << 20) / (2 * 3 * sizeof(double));
  if (matrix.size() <= kNearVertices) return product_rows<false>(matrix, x, y, begin, end);
  const auto row_ends = matrix.offsets.begin() + 1;
  const auto followed = static_cast<Index>(
      std::upper_bound(row_ends + begin, row_ends + end, matrix.block_count() - kAhead) - row_ends);
  return product_rows<true>(matrix, x, y, begin, followed) + product_rows<false>(matrix, x, y, followed, end);
}

double product_of_doubles(const BlockCsrOf<double>& matrix, const double* x, double* y, Index begin,
                          Index end) {
  return product(matrix, x, y, begin, end);
}

double product_of_floats(const BlockCsrOf<float>& matrix, const double* x, double* y, Index begin,
                         Index end) {
  return product(matrix, x, y, begin, end);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshorder {
namespace {

HWY_EXPORT(product_of_doubles);
HWY_EXPORT(product_of_floats);

}  // namespace

template <class Value>
double multiply_rows_dot(const BlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index begin_row, Index end_row) {
  const auto entries = 3 * static_cast<std::size_t>(matrix.size());
  if (x.size() != entries || y.size() != entries) {
    throw InvalidArgument("multiply: x and y must hold 3 doubles for each row of blocks");
  }
  if constexpr (std::is_same_v<Value, double>) {
    return HWY_DYNAMIC_DISPATCH(product_of_doubles)(matrix, x.data(), y.data(), begin_row, end_row);
  } else {
    return HWY_DYNAMIC_DISPATCH(product_of_floats)(matrix, x.data(), y.data(), begin_row, end_row);
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
