// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/half_block_csr.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/half_block_csr.cpp"
#include <hwy/foreach_target.h>
// the rest of this file is compiled once for each instruction set
#include "kernels/positions.hpp"

#include <hwy/highway.h>

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

// bytes between a block in use and the one prefetched; hardware prefetches less far ahead
constexpr Offset kBytesAhead = 3072;

#if HWY_MAX_BYTES >= 32
namespace hn = hwy::HWY_NAMESPACE;

/// The sums of a matrix row in a slab; also adds the row's blocks, transposed, to the sums of other rows.
/// Each row of a block is loaded together with the number after it; the products of that number are in lane 3
/// and never used.
class HalfRow {
 public:
  HWY_INLINE explicit HalfRow(const double* p)
      : p0_(hn::Set(Tag(), p[0])), p1_(hn::Set(Tag(), p[1])), p2_(hn::Set(Tag(), p[2])) {}

  /// Adds a block that is used only in this row.
  template <class Value>
  HWY_INLINE void add(const Value* block, const double* p) {
    const auto factors = load_three(p);
    row0_ = hn::MulAdd(load_four(block), factors, row0_);
    row1_ = hn::MulAdd(load_four(block + 3), factors, row1_);
    row2_ = hn::MulAdd(load_four(block + 6), factors, row2_);
  }

  /// Adds a block to this row and, transposed, to `column_sum`: the padded sum of the row whose number is the
  /// block's column.
  template <class Value>
  HWY_INLINE void add_both(const Value* block, const double* p, double* column_sum) {
    const Tag d;
    const auto factors = load_three(p);
    const auto block0 = load_four(block);
    const auto block1 = load_four(block + 3);
    const auto block2 = load_four(block + 6);
    row0_ = hn::MulAdd(block0, factors, row0_);
    row1_ = hn::MulAdd(block1, factors, row1_);
    row2_ = hn::MulAdd(block2, factors, row2_);
    // computed before `column_sum` is loaded: then only one addition waits for the latest store to
    // `column_sum`
    const auto column = hn::MulAdd(block2, p2_, hn::MulAdd(block1, p1_, hn::Mul(block0, p0_)));
    hn::Store(hn::Add(hn::Load(d, column_sum), column), d, column_sum);
  }

  /// Sets q to the sums of this row plus `column_sum`, the terms that other rows added, and zeroes
  /// `column_sum`.
  HWY_INLINE void finish(double* column_sum, double* q) const {
    const Tag d;
    const hn::Half<Tag> two;
    const auto even01 = hn::InterleaveLower(d, row0_, row1_);
    const auto odd01 = hn::InterleaveUpper(d, row0_, row1_);
    const auto even2 = hn::InterleaveLower(d, row2_, hn::Zero(d));
    const auto odd2 = hn::InterleaveUpper(d, row2_, hn::Zero(d));
    const auto added = hn::Load(d, column_sum);
    hn::Store(hn::Zero(d), d, column_sum);
    const auto sum01 =
        hn::Add(hn::Add(hn::LowerHalf(two, even01), hn::LowerHalf(two, odd01)), hn::UpperHalf(two, even01));
    const auto sum2 =
        hn::Add(hn::Add(hn::LowerHalf(two, even2), hn::LowerHalf(two, odd2)), hn::UpperHalf(two, even2));
    hn::StoreU(hn::Add(sum01, hn::LowerHalf(two, added)), two, q);
    q[2] = hn::GetLane(hn::Add(sum2, hn::UpperHalf(two, added)));
  }

 private:
  using Tag = hn::FixedTag<double, 4>;
  static HWY_INLINE hn::Vec<Tag> load_three(const double* p) {
    return hn::MaskedLoad(hn::FirstN(Tag(), 3), Tag(), p);
  }
  static HWY_INLINE hn::Vec<Tag> load_four(const double* p) { return hn::LoadU(Tag(), p); }
  static HWY_INLINE hn::Vec<Tag> load_four(const float* p) {
    return hn::PromoteTo(Tag(), hn::LoadU(hn::FixedTag<float, 4>(), p));
  }

  hn::Vec<Tag> p0_, p1_, p2_;
  hn::Vec<Tag> row0_ = hn::Zero(Tag());
  hn::Vec<Tag> row1_ = hn::Zero(Tag());
  hn::Vec<Tag> row2_ = hn::Zero(Tag());
};
#else
/// The same sums without vectors: vectors of two lanes would gain nothing.
class HalfRow {
 public:
  HWY_INLINE explicit HalfRow(const double* p) : p_(p) {}

  template <class Value>
  HWY_INLINE void add(const Value* block, const double* p) {
    for (int i = 0; i < 3; ++i) {
      sums_[i] += block[3 * i] * p[0] + block[3 * i + 1] * p[1] + block[3 * i + 2] * p[2];
    }
  }
  template <class Value>
  HWY_INLINE void add_both(const Value* block, const double* p, double* column_sum) {
    add(block, p);
    for (int i = 0; i < 3; ++i) {
      column_sum[i] += block[i] * p_[0] + block[3 + i] * p_[1] + block[6 + i] * p_[2];
    }
  }
  HWY_INLINE void finish(double* column_sum, double* q) const {
    for (int i = 0; i < 3; ++i) {
      q[i] = sums_[i] + column_sum[i];
      column_sum[i] = 0.0;
    }
  }

 private:
  const double* p_;
  double sums_[3] = {};
};
#endif

/// Computes the rows begin … end − 1, a slab, of y = A x; returns their part of xᵀA x. `sums` must hold
/// kPaddedStride zeros for each row; it holds zeros again afterwards. With `Gather`, prefetches x as well.
template <bool Gather, class Value>
double half_product_rows(const HalfBlockCsrOf<Value>& matrix, const double* x, double* sums, double* y,
                         Index begin, Index end) {
  constexpr Offset kValuesAhead = kBytesAhead / static_cast<Offset>(sizeof(Value));
  const Value* const values = matrix.values.data();
  const Index* const columns = matrix.columns.data();
  const Offset* const offsets = matrix.offsets.data();
  const auto sum_of = [&](Offset row) { return sums + kPaddedStride * (row - begin); };
  const auto ask_for = [&](Offset k) {
    __builtin_prefetch(values + 9 * k + kValuesAhead);
    if constexpr (Gather) {
      __builtin_prefetch(x + Offset{3} * columns[k + HalfBlockCsrOf<Value>::kSpareColumns]);
    }
  };
  double dot = 0.0;
  Offset k = offsets[Offset{2} * begin];
  for (Offset v = begin; v < end; ++v) {
    const double* const p = x + 3 * v;
    double* const q = y + 3 * v;
    HalfRow row(p);
    for (const Offset alone_end = offsets[2 * v + 1]; k < alone_end; ++k) {
      ask_for(k);
      row.add(values + 9 * k, x + Offset{3} * columns[k]);
    }
    for (const Offset row_end = offsets[2 * v + 2]; k < row_end; ++k) {
      ask_for(k);
      row.add_both(values + 9 * k, x + Offset{3} * columns[k], sum_of(columns[k]));
    }
    row.finish(sum_of(v), q);
    dot += p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  }
  return dot;
}

template <class Value>
double half_product(const HalfBlockCsrOf<Value>& matrix, const double* x, double* sums, double* y,
                    Index begin, Index end) {
  // a vector that fits into the second-level cache needs no prefetch
  constexpr Index kNearVertices = (Index{3} << 20) / (2 * 3 * sizeof(double));
  return matrix.size() <= kNearVertices ? half_product_rows<false>(matrix, x, sums, y, begin, end)
                                        : half_product_rows<true>(matrix, x, sums, y, begin, end);
}

double half_product_of_doubles(const HalfBlockCsr& matrix, const double* x, double* sums, double* y,
                               Index begin, Index end) {
  return half_product(matrix, x, sums, y, begin, end);
}

double half_product_of_floats(const HalfBlockCsrOf<float>& matrix, const double* x, double* sums, double* y,
                              Index begin, Index end) {
  return half_product(matrix, x, sums, y, begin, end);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/parallel.hpp"
#include "kernels/owned_batches.hpp"
#include "kernels/simd_dispatch.hpp"
#include <meshorder/error.hpp>

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(half_product_of_doubles);
MESHORDER_SIMD_VERSIONS(half_product_of_floats);

constexpr Index kSlabs = 16;

/// Returns the calling thread's array of zeros with kPaddedStride numbers for each row of a slab.
double* sums_of_thread(std::size_t rows) {
  thread_local AlignedVector<double> sums;
  const std::size_t needed = kPaddedStride * rows;
  if (sums.size() < needed) sums.assign(needed, 0.0);
  return sums.data();
}

/// Returns the number of blocks of the rows begin … end − 1 in columns outside begin … end − 1.
Offset blocks_between(const BlockCsr& matrix, Index begin, Index end) {
  Offset count = 0;
  for (Offset k = matrix.offsets[begin]; k < matrix.offsets[end]; ++k) {
    const Index column = matrix.columns[k];
    count += column < begin || column >= end ? 1 : 0;
  }
  return count;
}

/// Numbers of a row's stored blocks that are used only in this row (`alone`) and in two rows (`both`).
struct RowCounts {
  Offset alone = 0, both = 0;
};

RowCounts counts_of(const BlockCsr& matrix, Index row, Index begin, Index end) {
  RowCounts counts;
  for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
    const Index column = matrix.columns[k];
    if (column > row && column < end) {
      ++counts.both;
    } else if (column == row || column < begin || column >= end) {
      ++counts.alone;
    }
  }
  return counts;
}

}  // namespace

std::vector<Index> slabs_of(const BlockCsr& matrix) {
  return balanced_ranges(matrix.offsets, std::clamp<Index>(matrix.size(), 1, kSlabs));
}

double share_between_slabs(const BlockCsr& matrix) {
  if (matrix.block_count() == 0) return 0.0;
  const std::vector<Index> slabs = slabs_of(matrix);
  const auto between = sum_over_chunks<Offset>(index_size(slabs) - 1, 1, [&](Index slab, Index) {
    return blocks_between(matrix, slabs[slab], slabs[slab + 1]);
  });
  return static_cast<double>(between) / static_cast<double>(matrix.block_count());
}

template <class Value>
void store_half(const BlockCsr& matrix, HalfBlockCsrOf<Value>& result) {
  result.slabs = slabs_of(matrix);
  const Index n = matrix.size();
  result.offsets.resize(2 * static_cast<std::size_t>(n) + 1);
  for_each_part(result.slab_count(), [&](Index slab) {
    const Index begin = result.slabs[slab];
    const Index end = result.slabs[slab + 1];
    for (Index v = begin; v < end; ++v) {
      const RowCounts counts = counts_of(matrix, v, begin, end);
      result.offsets[2 * Offset{v} + 1] = counts.alone;
      result.offsets[2 * Offset{v} + 2] = counts.both;
    }
  });
  for (std::size_t i = 1; i < result.offsets.size(); ++i) result.offsets[i] += result.offsets[i - 1];
  const auto blocks = static_cast<std::size_t>(result.block_count());
  result.columns.resize(blocks + HalfBlockCsrOf<Value>::kSpareColumns);
  std::fill(result.columns.begin() + result.block_count(), result.columns.end(), 0);
  result.values.resize(9 * blocks + 1);
  result.values.back() = 0;
  for_each_part(result.slab_count(), [&](Index slab) {
    const Index begin = result.slabs[slab];
    const Index end = result.slabs[slab + 1];
    for (Index v = begin; v < end; ++v) {
      Offset alone = result.offsets[2 * Offset{v}];
      Offset both = result.offsets[2 * Offset{v} + 1];
      for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
        const Index column = matrix.columns[k];
        if (column >= begin && column < v) continue;
        const Offset to = column > v && column < end ? both++ : alone++;
        result.columns[to] = column;
        std::transform(matrix.values.begin() + 9 * k, matrix.values.begin() + 9 * k + 9,
                       result.values.begin() + 9 * to,
                       [](double value) { return static_cast<Value>(value); });
      }
    }
  });
}

template <class Value>
double multiply_slab_dot(const HalfBlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y,
                         Index slab) {
  const auto entries = 3 * static_cast<std::size_t>(matrix.size());
  if (x.size() != entries || y.size() != entries) {
    throw InvalidArgument("multiply: x and y must hold 3 doubles for each row of blocks");
  }
  const Index begin = matrix.slabs[slab];
  const Index end = matrix.slabs[slab + 1];
  if (begin == end) return 0.0;
  double* const sums = sums_of_thread(static_cast<std::size_t>(end - begin));
  if constexpr (std::is_same_v<Value, double>) {
    return MESHORDER_SIMD(half_product_of_doubles)(matrix, x.data(), sums, y.data(), begin, end);
  } else {
    return MESHORDER_SIMD(half_product_of_floats)(matrix, x.data(), sums, y.data(), begin, end);
  }
}

template <class Value>
void multiply(const HalfBlockCsrOf<Value>& matrix, std::span<const double> x, std::span<double> y) {
  for_each_part(matrix.slab_count(), [&](Index slab) { (void)multiply_slab_dot(matrix, x, y, slab); });
}

template void store_half(const BlockCsr&, HalfBlockCsr&);
template void store_half(const BlockCsr&, HalfBlockCsrOf<float>&);
template double multiply_slab_dot(const HalfBlockCsr&, std::span<const double>, std::span<double>, Index);
template double multiply_slab_dot(const HalfBlockCsrOf<float>&, std::span<const double>, std::span<double>,
                                  Index);
template void multiply(const HalfBlockCsr&, std::span<const double>, std::span<double>);
template void multiply(const HalfBlockCsrOf<float>&, std::span<const double>, std::span<double>);

bool half_storage_pays(const BlockCsr& matrix) {
  // larger than most second-level caches; for a smaller matrix the copy does not pay
  constexpr Offset kMinBytes = Offset{4} << 20;
  // stored blocks are read at about 0.8 of the full matrix's rate, and (1 + share) / 2 of all blocks are
  // stored: the break-even share is 0.6
  constexpr double kMaxShare = 0.5;
  constexpr Offset kBlockBytes = 9 * sizeof(double) + sizeof(Index);
  return kBlockBytes * matrix.block_count() >= kMinBytes && share_between_slabs(matrix) < kMaxShare;
}

}  // namespace meshorder
#endif
