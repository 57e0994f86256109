// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/kernels/positions.hpp>
#include <meshorder/sim/linear/panel_sweeps.hpp>

#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "meshorder/sim/linear/panel_sweeps.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include <hwy/highway.h>

#undef MESHORDER_UNROLL
#define MESHORDER_UNROLL _Pragma("GCC unroll 16")

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
HWY_INLINE Real* at(Real* x, Index place) {
  return x + Offset{kPaddedStride} * place;
}

constexpr int kGroup = Panel::kGroup;

/// Where the bytes of a factor come from in a register that starts with one for each vertex.
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
constexpr Spread<Real> kSpread;

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

  static HWY_INLINE Vertex zero() {
    Vertex result;
    MESHORDER_UNROLL
    for (int i = 0; i < kParts; ++i) result.part[i] = hn::Zero(Tag());
    return result;
  }
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
  static_assert(kGroup % kCount == 0);
  using Tag = hn::CappedTag<Real, kCount * One::kLanes>;
  hn::Vec<Tag> part[One::kParts];

  static HWY_INLINE Vertices zero() {
    Vertices result;
    MESHORDER_UNROLL
    for (int i = 0; i < One::kParts; ++i) result.part[i] = hn::Zero(Tag());
    return result;
  }
  /// The same vertex in all places.
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
  /// Less of[i] · factors[i] in place i. Reads 16 bytes of factors.
  HWY_INLINE void subtract_products(const Real* factors, const Vertices& of) {
    const auto spread = spread_out(Tag(), factors);
    MESHORDER_UNROLL
    for (int i = 0; i < One::kParts; ++i) part[i] = hn::NegMulAdd(spread, of.part[i], part[i]);
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
  /// factors[0] four times, factors[1] four times …
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

/// x = L⁻¹ x for the columns of a panel, and 1/D times that to the vector.
template <int Width, class Real>
HWY_INLINE void eliminate(const Real* values, Vertex<Real> (&y)[Width], Real* own) {
  MESHORDER_UNROLL
  for (int j = 0; j < Width; ++j) y[j] = Vertex<Real>::load(own + kPaddedStride * j);
  MESHORDER_UNROLL
  for (int i = 1; i < Width; ++i) {
    MESHORDER_UNROLL
    for (int j = 0; j < i; ++j) y[i].subtract_product(*values++, y[j]);
  }
  MESHORDER_UNROLL
  for (int j = 0; j < Width; ++j) {
    Vertex<Real> z = y[j];
    z *= *values++;
    z.store(own + kPaddedStride * j);
  }
}

template <int Width, class Real>
HWY_INLINE void panel_forwards(const Index* rows, Index row_count, const Real* values, Real* own, Real* x) {
  using Several = Vertices<Real>;
  Vertex<Real> y[Width];
  eliminate<Width>(values, y, own);
  values += Width * (Width + 1) / 2;
  Several everywhere[Width];
  MESHORDER_UNROLL
  for (int j = 0; j < Width; ++j) everywhere[j] = Several::all(y[j]);
  for (; row_count >= kGroup; row_count -= kGroup) {
    MESHORDER_UNROLL
    for (int r = 0; r < kGroup; r += Several::kCount) {
      Several sums = Several::load(x, rows + r);
      MESHORDER_UNROLL
      for (int j = 0; j < Width; ++j) sums.subtract_products(values + kGroup * j + r, everywhere[j]);
      sums.store(x, rows + r);
    }
    values += kGroup * Width;
    rows += kGroup;
  }
  for (Index r = 0; r < row_count; ++r) {
    auto sum = Vertex<Real>::load(at(x, rows[r]));
    MESHORDER_UNROLL
    for (int j = 0; j < Width; ++j) sum.subtract_product(values[row_count * j + r], y[j]);
    sum.store(at(x, rows[r]));
  }
}

/// Processors look less far ahead by themselves, and hardly where addresses fall.
template <int Bytes, class Real>
HWY_INLINE void ask_for_those_before(const Real* values) {
  constexpr int kBytesAhead = 4096;
  MESHORDER_UNROLL
  for (int line = 0; line < Bytes; line += 64) {
    __builtin_prefetch(reinterpret_cast<const char*>(values) + line - kBytesAhead);
  }
}

template <int Width, class Real>
HWY_INLINE void panel_backwards(const Index* rows, Index row_count, const Real* values, Real* own,
                                const Real* x) {
  using Several = Vertices<Real>;
  constexpr int kTriangle = Width * (Width - 1) / 2;
  // rows in turn to sums of their own: additions to one sum would wait for each other
  constexpr int kSums = HWY_MIN(kGroup / Several::kCount, Width >= 4 ? 1 : Width >= 2 ? 2 : 4);
  Several sums[kSums][Width];
  MESHORDER_UNROLL
  for (int k = 0; k < kSums; ++k) {
    MESHORDER_UNROLL
    for (int j = 0; j < Width; ++j) sums[k][j] = Several::zero();
  }
  Vertex<Real> y[Width];
  MESHORDER_UNROLL
  for (int j = 0; j < Width; ++j) y[j] = Vertex<Real>::load(own + kPaddedStride * j);

  const Index single = row_count % kGroup;
  const Real* below = values + kTriangle + Width + Offset{Width} * (row_count - single);
  rows += row_count - single;
  for (Index r = 0; r < single; ++r) {
    const auto there = Vertex<Real>::load(at(x, rows[r]));
    MESHORDER_UNROLL
    for (int j = 0; j < Width; ++j) y[j].subtract_product(below[single * j + r], there);
  }
  for (Index left = row_count - single; left > 0; left -= kGroup) {
    below -= kGroup * Width;
    rows -= kGroup;
    ask_for_those_before<static_cast<int>(kGroup * Width * sizeof(Real))>(below);
    MESHORDER_UNROLL
    for (int r = 0; r < kGroup; r += Several::kCount) {
      const Several there = Several::load(x, rows + r);
      MESHORDER_UNROLL
      for (int j = 0; j < Width; ++j) {
        sums[r / Several::kCount % kSums][j].subtract_products(below + kGroup * j + r, there);
      }
    }
  }
  MESHORDER_UNROLL
  for (int j = 0; j < Width; ++j) {
    MESHORDER_UNROLL
    for (int k = 0; k < kSums; ++k) y[j] += sums[k][j].sum();
  }

  const Real* left = values + kTriangle;
  MESHORDER_UNROLL
  for (int i = Width - 1; i >= 0; --i) {
    left -= i;
    y[i].store(own + kPaddedStride * i);
    MESHORDER_UNROLL
    for (int j = 0; j < i; ++j) y[j].subtract_product(left[j], y[i]);
  }
}

template <class Real>
HWY_INLINE void forwards(const PanelView<Real>& view, const PanelRange& range, Real* x) {
  for (Index k = 0; k < range.count; ++k) {
    const Panel& panel = view.panels[range[k]];
    const Index* const rows = view.rows + panel.rows;
    const Real* const values = view.values + panel.values;
    Real* const own = at(x, panel.column);
    static_assert(Panel::kWidest == 8);
    switch (panel.width) {
      case 1:
        panel_forwards<1>(rows, panel.row_count, values, own, x);
        break;
      case 2:
        panel_forwards<2>(rows, panel.row_count, values, own, x);
        break;
      case 3:
        panel_forwards<3>(rows, panel.row_count, values, own, x);
        break;
      case 4:
        panel_forwards<4>(rows, panel.row_count, values, own, x);
        break;
      case 5:
        panel_forwards<5>(rows, panel.row_count, values, own, x);
        break;
      case 6:
        panel_forwards<6>(rows, panel.row_count, values, own, x);
        break;
      case 7:
        panel_forwards<7>(rows, panel.row_count, values, own, x);
        break;
      default:
        panel_forwards<8>(rows, panel.row_count, values, own, x);
        break;
    }
  }
}

template <class Real>
HWY_INLINE void backwards(const PanelView<Real>& view, const PanelRange& range, Real* x) {
  for (Index k = range.count - 1; k >= 0; --k) {
    const Panel& panel = view.panels[range[k]];
    const Index* const rows = view.rows + panel.rows;
    const Real* const values = view.values + panel.values;
    Real* const own = at(x, panel.column);
    switch (panel.width) {
      case 1:
        panel_backwards<1>(rows, panel.row_count, values, own, x);
        break;
      case 2:
        panel_backwards<2>(rows, panel.row_count, values, own, x);
        break;
      case 3:
        panel_backwards<3>(rows, panel.row_count, values, own, x);
        break;
      case 4:
        panel_backwards<4>(rows, panel.row_count, values, own, x);
        break;
      case 5:
        panel_backwards<5>(rows, panel.row_count, values, own, x);
        break;
      case 6:
        panel_backwards<6>(rows, panel.row_count, values, own, x);
        break;
      case 7:
        panel_backwards<7>(rows, panel.row_count, values, own, x);
        break;
      default:
        panel_backwards<8>(rows, panel.row_count, values, own, x);
        break;
    }
  }
}

void forwards_of_doubles(const PanelView<double>& view, const PanelRange& range, double* x) {
  forwards(view, range, x);
}
void forwards_of_floats(const PanelView<float>& view, const PanelRange& range, float* x) {
  forwards(view, range, x);
}
void backwards_of_doubles(const PanelView<double>& view, const PanelRange& range, double* x) {
  backwards(view, range, x);
}
void backwards_of_floats(const PanelView<float>& view, const PanelRange& range, float* x) {
  backwards(view, range, x);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshorder {
namespace {

HWY_EXPORT(forwards_of_doubles);
HWY_EXPORT(forwards_of_floats);
HWY_EXPORT(backwards_of_doubles);
HWY_EXPORT(backwards_of_floats);

}  // namespace

void sweep_forwards(const PanelView<double>& view, const PanelRange& range, double* x) {
  HWY_DYNAMIC_DISPATCH(forwards_of_doubles)(view, range, x);
}

void sweep_forwards(const PanelView<float>& view, const PanelRange& range, float* x) {
  HWY_DYNAMIC_DISPATCH(forwards_of_floats)(view, range, x);
}

void sweep_backwards(const PanelView<double>& view, const PanelRange& range, double* x) {
  HWY_DYNAMIC_DISPATCH(backwards_of_doubles)(view, range, x);
}

void sweep_backwards(const PanelView<float>& view, const PanelRange& range, float* x) {
  HWY_DYNAMIC_DISPATCH(backwards_of_floats)(view, range, x);
}

}  // namespace meshorder
#endif
