// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set: Highway's foreach_target.h compiles the including file repeatedly.
#if defined(MESHORDER_VERTICES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_VERTICES_INL
#undef MESHORDER_VERTICES_INL
#else
#define MESHORDER_VERTICES_INL
#endif

#include "kernels/positions.hpp"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#undef MESHORDER_UNROLL
#define MESHORDER_UNROLL _Pragma("GCC unroll 16")

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Returns the numbers of vertex `place` in a vector with kPaddedStride numbers for each vertex.
template <class Real>
HWY_INLINE Real* at(Real* x, Index place) {
  return x + Offset{kPaddedStride} * place;
}

/// Byte indices of the shuffle that fills all lanes of vertex i with factor i.
template <class Real>
struct Spread {
  alignas(64) std::uint8_t places[64] = {};
  constexpr Spread() {
    for (unsigned i = 0; i < 64; ++i) {
      places[i] =
          static_cast<std::uint8_t>(i / (kPaddedStride * sizeof(Real)) * sizeof(Real) + i % sizeof(Real));
    }
  }
};
template <class Real>
[[maybe_unused]] constexpr Spread<Real> kSpread;  // unused where a register holds one vertex

/// The numbers of a vertex, in as many registers as they need.
template <class Real>
struct Vertex {
#if HWY_TARGET == HWY_SCALAR
  static constexpr int kLanes = 1;
#else
  static constexpr int kLanes = HWY_MIN(kPaddedStride, HWY_MAX_BYTES / static_cast<int>(sizeof(Real)));
#endif
  static constexpr int kParts = kPaddedStride / kLanes;
  using Tag = hn::CappedTag<Real, kLanes>;
  hn::Vec<Tag> part[kParts];

  static HWY_INLINE Vertex load(const Real* from) {
    Vertex result;
    MESHORDER_UNROLL
    for (int i = 0; i < kParts; ++i) result.part[i] = hn::Load(Tag(), from + kLanes * i);
    return result;
  }
  HWY_INLINE void store(Real* to) const {
    MESHORDER_UNROLL
    for (int i = 0; i < kParts; ++i) hn::Store(part[i], Tag(), to + kLanes * i);
  }
  HWY_INLINE void subtract_product(Real factor, const Vertex& of) {
    const auto factors = hn::Set(Tag(), factor);
    MESHORDER_UNROLL
    for (int i = 0; i < kParts; ++i) part[i] = hn::NegMulAdd(factors, of.part[i], part[i]);
  }
  HWY_INLINE void operator*=(Real factor) {
    const auto factors = hn::Set(Tag(), factor);
    MESHORDER_UNROLL
    for (int i = 0; i < kParts; ++i) part[i] = hn::Mul(factors, part[i]);
  }
  HWY_INLINE void operator+=(const Vertex& other) {
    MESHORDER_UNROLL
    for (int i = 0; i < kParts; ++i) part[i] = hn::Add(part[i], other.part[i]);
  }
};

/// As many vertices side by side as a register holds.
template <class Real>
struct Vertices {
  using One = Vertex<Real>;
#if HWY_TARGET == HWY_SCALAR
  static constexpr int kCount = 1;
#else
  static constexpr int kCount = HWY_MAX(1, HWY_MAX_BYTES / static_cast<int>(kPaddedStride * sizeof(Real)));
#endif
  using Tag = hn::CappedTag<Real, kCount * One::kLanes>;
  hn::Vec<Tag> part[One::kParts];

  static HWY_INLINE Vertices zero() {
    Vertices result;
    MESHORDER_UNROLL
    for (int i = 0; i < One::kParts; ++i) result.part[i] = hn::Zero(Tag());
    return result;
  }
  /// Returns kCount copies of a vertex.
  static HWY_INLINE Vertices all(const One& vertex) {
    Vertices result;
    MESHORDER_UNROLL
    for (int i = 0; i < One::kParts; ++i) result.part[i] = repeated(Tag(), vertex.part[i]);
    return result;
  }
  static HWY_INLINE Vertices load(const Real* x, const Index* places) {
    Vertices result;
    MESHORDER_UNROLL
    for (int i = 0; i < One::kParts; ++i) result.part[i] = gathered(Tag(), x + One::kLanes * i, places);
    return result;
  }
  HWY_INLINE void store(Real* x, const Index* places) const {
    MESHORDER_UNROLL
    for (int i = 0; i < One::kParts; ++i) scatter(Tag(), part[i], x + One::kLanes * i, places);
  }
  /// Subtracts others[i] · factors[i] from vertex i. Reads 16 bytes from `factors`.
  HWY_INLINE void subtract_products(const Real* factors, const Vertices& others) {
    const auto spread = spread_out(Tag(), factors);
    MESHORDER_UNROLL
    for (int i = 0; i < One::kParts; ++i) part[i] = hn::NegMulAdd(spread, others.part[i], part[i]);
  }
  [[nodiscard]] HWY_INLINE One sum() const {
    One result;
    MESHORDER_UNROLL
    for (int i = 0; i < One::kParts; ++i) result.part[i] = sum_of(Tag(), part[i]);
    return result;
  }

 private:
#if HWY_TARGET == HWY_SCALAR
  static HWY_INLINE hn::Vec<Tag> repeated(Tag, hn::Vec<Tag> vertex) { return vertex; }
  static HWY_INLINE hn::Vec<Tag> gathered(Tag d, const Real* x, const Index* places) {
    return hn::Load(d, at(x, *places));
  }
  static HWY_INLINE void scatter(Tag d, hn::Vec<Tag> vertices, Real* x, const Index* places) {
    hn::Store(vertices, d, at(x, *places));
  }
  static HWY_INLINE hn::Vec<Tag> sum_of(Tag, hn::Vec<Tag> vertices) { return vertices; }
  static HWY_INLINE hn::Vec<Tag> spread_out(Tag d, const Real* factors) { return hn::Set(d, *factors); }
#else
  template <class D>
  static constexpr bool kIsOne = MaxLanes(D()) <= static_cast<std::size_t>(One::kLanes);

  template <class D>
  static HWY_INLINE hn::Vec<D> repeated(D d, hn::Vec<typename One::Tag> vertex) {
    if constexpr (kIsOne<D>) {
      return vertex;
    } else {
      const auto half = repeated(hn::Half<D>(), vertex);
      return hn::Combine(d, half, half);
    }
  }
  template <class D>
  static HWY_INLINE hn::Vec<D> gathered(D d, const Real* x, const Index* places) {
    if constexpr (kIsOne<D>) {
      return hn::Load(d, at(x, *places));
    } else {
      const hn::Half<D> half;
      const auto lower = gathered(half, x, places);
      return hn::Combine(d, gathered(half, x, places + MaxLanes(half) / One::kLanes), lower);
    }
  }
  template <class D>
  static HWY_INLINE void scatter(D d, hn::Vec<D> vertices, Real* x, const Index* places) {
    if constexpr (kIsOne<D>) {
      hn::Store(vertices, d, at(x, *places));
    } else {
      const hn::Half<D> half;
      scatter(half, hn::LowerHalf(half, vertices), x, places);
      scatter(half, hn::UpperHalf(half, vertices), x, places + MaxLanes(half) / One::kLanes);
    }
  }
  template <class D>
  static HWY_INLINE hn::Vec<typename One::Tag> sum_of(D, hn::Vec<D> vertices) {
    if constexpr (kIsOne<D>) {
      return vertices;
    } else {
      const hn::Half<D> half;
      return sum_of(half, hn::Add(hn::LowerHalf(half, vertices), hn::UpperHalf(half, vertices)));
    }
  }
  /// Returns factors[0] four times, factors[1] four times …
  template <class D>
  static HWY_INLINE hn::Vec<D> spread_out(D d, const Real* factors) {
    if constexpr (kCount == 1) {
      return hn::Set(d, *factors);
    } else {
      const hn::Repartition<std::uint8_t, D> bytes;
      const auto places = hn::Load(bytes, kSpread<Real>.places);
      return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(bytes, hn::LoadDup128(d, factors)), places));
    }
  }
#endif
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
