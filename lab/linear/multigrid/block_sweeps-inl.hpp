// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set: Highway's foreach_target.h compiles the including file repeatedly.
#if defined(MESHORDER_BLOCK_SWEEPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_BLOCK_SWEEPS_INL
#undef MESHORDER_BLOCK_SWEEPS_INL
#else
#define MESHORDER_BLOCK_SWEEPS_INL
#endif

#include "base/index.hpp"

#include <hwy/highway.h>

#undef MESHORDER_UNROLL
#define MESHORDER_UNROLL _Pragma("GCC unroll 16")

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Four floats.
#if HWY_TARGET == HWY_SCALAR
struct Quad {
  float lanes[4];

  static HWY_INLINE Quad set(float value) { return {{value, value, value, value}}; }
  static HWY_INLINE Quad load(const float* from) { return {{from[0], from[1], from[2], from[3]}}; }
  HWY_INLINE void store(float* to) const {
    for (int i = 0; i < 4; ++i) to[i] = lanes[i];
  }
  /// Returns the first `count` lanes, then zeros.
  HWY_INLINE Quad first(int count) const {
    Quad result = set(0);
    for (int i = 0; i < count; ++i) result.lanes[i] = lanes[i];
    return result;
  }
  HWY_INLINE Quad operator+(Quad b) const { return mul_add(*this, set(1), b); }
  HWY_INLINE Quad operator-(Quad b) const { return mul_add(b, set(-1), *this); }
  HWY_INLINE Quad operator*(Quad b) const { return mul_add(*this, b, set(0)); }
  /// Returns a b + c.
  static HWY_INLINE Quad mul_add(Quad a, Quad b, Quad c) {
    for (int i = 0; i < 4; ++i) c.lanes[i] += a.lanes[i] * b.lanes[i];
    return c;
  }
  /// Returns c − a b.
  static HWY_INLINE Quad subtract_product(Quad a, Quad b, Quad c) { return mul_add(a * set(-1), b, c); }
  /// Returns four sums: lane i is the sum of the lanes of four[i].
  static HWY_INLINE Quad sums(const Quad* four) {
    Quad result;
    for (int i = 0; i < 4; ++i) {
      const float* const x = four[i].lanes;
      result.lanes[i] = (x[0] + x[2]) + (x[1] + x[3]);
    }
    return result;
  }
};
#else
struct Quad {
  using Tag = hn::FixedTag<float, 4>;
  hn::Vec<Tag> lanes;

  static HWY_INLINE Quad set(float value) { return {hn::Set(Tag(), value)}; }
  static HWY_INLINE Quad load(const float* from) { return {hn::LoadU(Tag(), from)}; }
  HWY_INLINE void store(float* to) const { hn::StoreU(lanes, Tag(), to); }
  HWY_INLINE Quad first(int count) const { return {hn::IfThenElseZero(hn::FirstN(Tag(), count), lanes)}; }
  HWY_INLINE Quad operator+(Quad b) const { return {lanes + b.lanes}; }
  HWY_INLINE Quad operator-(Quad b) const { return {lanes - b.lanes}; }
  HWY_INLINE Quad operator*(Quad b) const { return {lanes * b.lanes}; }
  static HWY_INLINE Quad mul_add(Quad a, Quad b, Quad c) { return {hn::MulAdd(a.lanes, b.lanes, c.lanes)}; }
  static HWY_INLINE Quad subtract_product(Quad a, Quad b, Quad c) {
    return {hn::NegMulAdd(a.lanes, b.lanes, c.lanes)};
  }
  static HWY_INLINE Quad sums(const Quad* four) {
    const Tag d;
    const auto ab = hn::InterleaveLower(d, four[0].lanes, four[1].lanes) +
                    hn::InterleaveUpper(d, four[0].lanes, four[1].lanes);
    const auto cd = hn::InterleaveLower(d, four[2].lanes, four[3].lanes) +
                    hn::InterleaveUpper(d, four[2].lanes, four[3].lanes);
    return {hn::ConcatLowerLower(d, cd, ab) + hn::ConcatUpperUpper(d, cd, ab)};
  }
};
#endif

/// R floats of a node; the lanes after them may hold anything.
template <int R>
struct Node {
  static constexpr int kQuads = (R + 3) / 4;
  static constexpr Index kStride = 4 * kQuads;
  Quad part[kQuads];

  static HWY_INLINE Node zero() {
    Node result;
    MESHORDER_UNROLL
    for (int q = 0; q < kQuads; ++q) result.part[q] = Quad::set(0);
    return result;
  }
  static HWY_INLINE Node load(const float* from) {
    Node result;
    MESHORDER_UNROLL
    for (int q = 0; q < kQuads; ++q) result.part[q] = Quad::load(from + 4 * q);
    return result;
  }
  HWY_INLINE void store(float* to) const {
    MESHORDER_UNROLL
    for (int q = 0; q < kQuads; ++q) part[q].store(to + 4 * q);
  }
  /// Returns the R floats with zeros after them.
  HWY_INLINE Node clean() const {
    Node result = *this;
    result.part[kQuads - 1] = part[kQuads - 1].first(R - 4 * (kQuads - 1));
    return result;
  }
  HWY_INLINE Node operator+(const Node& b) const {
    Node result;
    MESHORDER_UNROLL
    for (int q = 0; q < kQuads; ++q) result.part[q] = part[q] + b.part[q];
    return result;
  }
  HWY_INLINE Node operator-(const Node& b) const {
    Node result;
    MESHORDER_UNROLL
    for (int q = 0; q < kQuads; ++q) result.part[q] = part[q] - b.part[q];
    return result;
  }
};

/// Sums of products with blocks of R×C numbers, stored column by column. Each column has a sum of its own, so
/// that additions need not wait for each other.
template <int R, int C>
struct ProductSum {
  Node<R> of_column[C];

  static HWY_INLINE ProductSum zero() {
    ProductSum result;
    MESHORDER_UNROLL
    for (int c = 0; c < C; ++c) result.of_column[c] = Node<R>::zero();
    return result;
  }
  /// Adds block · x.
  HWY_INLINE void add(const float* block, const float* x) {
    MESHORDER_UNROLL
    for (int c = 0; c < C; ++c) {
      const Quad entry = Quad::set(x[c]);
      MESHORDER_UNROLL
      for (int q = 0; q < Node<R>::kQuads; ++q) {
        Quad& sum = of_column[c].part[q];
        sum = Quad::mul_add(Quad::load(block + R * c + 4 * q), entry, sum);
      }
    }
  }
  HWY_INLINE Node<R> total() const {
    if constexpr (C == 3) return (of_column[0] + of_column[1]) + of_column[2];
    if constexpr (C == 6) {
      return ((of_column[0] + of_column[1]) + (of_column[2] + of_column[3])) + (of_column[4] + of_column[5]);
    }
  }
};

/// Adds blockᵀ · x to y. The block has R×C numbers, column by column. Lanes of x after R floats must be 0.
template <int R, int C>
HWY_INLINE void add_transposed_product(const float* block, const Node<R>& x, float* y) {
  constexpr int kQuads = Node<C>::kQuads;
  Quad products[4 * kQuads];
  MESHORDER_UNROLL
  for (int c = 0; c < 4 * kQuads; ++c) {
    if (c >= C) {
      products[c] = Quad::set(0);
      continue;
    }
    products[c] = Quad::load(block + R * c) * x.part[0];
    MESHORDER_UNROLL
    for (int q = 1; q < Node<R>::kQuads; ++q) {
      products[c] = Quad::mul_add(Quad::load(block + R * c + 4 * q), x.part[q], products[c]);
    }
  }
  MESHORDER_UNROLL
  for (int q = 0; q < kQuads; ++q) {
    (Quad::load(y + 4 * q) + Quad::sums(products + 4 * q)).store(y + 4 * q);
  }
}

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
