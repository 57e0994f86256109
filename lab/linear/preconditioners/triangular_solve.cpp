// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/preconditioners/triangular_solve.hpp"

#include "lab/linear/preconditioners/symmetric_block.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/linear/preconditioners/triangular_solve.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/block_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

#if HWY_MAX_BYTES >= 32
/// A vector p; subtracts blockᵀ · p from z, by rows of the block.
struct TransposedProduct {
  using Four = hn::FixedTag<double, 4>;
  hn::Vec<Four> p0, p1, p2;

  explicit HWY_INLINE TransposedProduct(const double* p)
      : p0(hn::Set(Four(), p[0])), p1(hn::Set(Four(), p[1])), p2(hn::Set(Four(), p[2])) {}

  HWY_INLINE void subtract_from(double* z, const float* block) const {
    auto sum = hn::Mul(row(block), p0);
    sum = hn::MulAdd(row(block + 3), p1, sum);
    sum = hn::MulAdd(row(block + 6), p2, sum);
    // stores two numbers, then one: later loads have these sizes
    const hn::Half<Four> two;
    hn::StoreU(hn::Sub(hn::LoadU(two, z), hn::LowerHalf(two, sum)), two, z);
    z[2] -= hn::GetLane(hn::UpperHalf(two, sum));
  }

 private:
  static HWY_INLINE hn::Vec<Four> row(const float* entries) {
    return hn::PromoteTo(Four(), hn::LoadU(hn::Rebind<float, Four>(), entries));
  }
};
#else
struct TransposedProduct {
  double p0, p1, p2;

  explicit HWY_INLINE TransposedProduct(const double* p) : p0(p[0]), p1(p[1]), p2(p[2]) {}

  HWY_INLINE void subtract_from(double* z, const float* block) const {
    for (int c = 0; c < 3; ++c) z[c] -= block[c] * p0 + block[3 + c] * p1 + block[6 + c] * p2;
  }
};
#endif

// distance of prefetching, in blocks, as in the product with a matrix
constexpr Offset kAhead = 128;

void lower(const BlockFactor& factor, const double* r, double* z, Index begin, Index end) {
  Offset k = factor.offsets[begin];
  for (Index i = begin; i < end; ++i) {
    const Offset place = Offset{3} * factor.vertices[i];
    RowSums sums;
    for (const Offset row_end = factor.offsets[i + 1]; k < row_end; ++k) {
      __builtin_prefetch(factor.values + 9 * (k + kAhead));
      sums.add(factor.values + 9 * k, z + Offset{3} * factor.columns[k]);
    }
    sums.subtract_from(r + place, z + place);
  }
}

void upper(const BlockFactor& factor, double* z, Index begin, Index end) {
  for (Index i = end; i-- > begin;) {
    const TransposedProduct product(z + Offset{3} * factor.vertices[i]);
    for (Offset k = factor.offsets[i]; k < factor.offsets[i + 1]; ++k) {
      __builtin_prefetch(factor.values + 9 * (k - kAhead));
      product.subtract_from(z + Offset{3} * factor.columns[k], factor.values + 9 * k);
    }
  }
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(lower);
MESHORDER_SIMD_VERSIONS(upper);

}  // namespace

void solve_lower(const BlockFactor& factor, const double* r, double* z, Index begin, Index end) {
  MESHORDER_SIMD(lower)(factor, r, z, begin, end);
}

void solve_upper(const BlockFactor& factor, double* z, Index begin, Index end) {
  MESHORDER_SIMD(upper)(factor, z, begin, end);
}

void solve_diagonal(const BlockFactor& factor, double* z, Index begin, Index end) {
  for (Index i = begin; i < end; ++i) {
    const Offset v = factor.vertices[i];
    multiply(factor.inverses + 6 * v, z + 3 * v, z + 3 * v);
  }
}

}  // namespace meshorder
#endif
