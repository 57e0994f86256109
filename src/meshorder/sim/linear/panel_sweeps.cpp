// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/kernels/positions.hpp>
#include <meshorder/sim/linear/panel_sweeps.hpp>

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

/// Processors look less far ahead by themselves, and hardly where addresses fall.
constexpr int kBytesAhead = 4096;

template <class Real>
HWY_INLINE Real* at(Real* x, Index place) {
  return x + Offset{kPaddedStride} * place;
}

template <int Width, class Real>
HWY_INLINE void panel_forwards(const Index* rows, Index row_count, const Real* values, Real* own, Real* x) {
  Vertex<Real> y[Width];
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
  for (Index r = 0; r < row_count; ++r) {
    Real* const place = at(x, rows[r]);
    auto sum = Vertex<Real>::load(place);
    MESHORDER_UNROLL
    for (int j = 0; j < Width; ++j) sum.subtract_product(values[j], y[j]);
    sum.store(place);
    values += Width;
  }
}

template <int Width, class Real>
HWY_INLINE void panel_backwards(const Index* rows, Index row_count, const Real* values, Real* own,
                                const Real* x) {
  // rows in turn to sums of their own: additions of one sum would wait for each other
  constexpr int kSums = Width >= 4 ? 1 : Width >= 2 ? 2 : 4;
  constexpr int kTriangle = Width * (Width - 1) / 2;
  Vertex<Real> sums[kSums][Width];
  MESHORDER_UNROLL
  for (int j = 0; j < Width; ++j) {
    sums[0][j] = Vertex<Real>::load(own + kPaddedStride * j);
    MESHORDER_UNROLL
    for (int k = 1; k < kSums; ++k) sums[k][j] = Vertex<Real>::zero();
  }
  const Real* below = values + kTriangle + Width + Offset{Width} * row_count;
  Index r = row_count;
  while (r >= kSums) {
    MESHORDER_UNROLL
    for (int k = 0; k < kSums; ++k) {
      below -= Width;
      __builtin_prefetch(reinterpret_cast<const char*>(below) - kBytesAhead);
      const auto there = Vertex<Real>::load(at(x, rows[--r]));
      MESHORDER_UNROLL
      for (int j = 0; j < Width; ++j) sums[k][j].subtract_product(below[j], there);
    }
  }
  while (r > 0) {
    below -= Width;
    const auto there = Vertex<Real>::load(at(x, rows[--r]));
    MESHORDER_UNROLL
    for (int j = 0; j < Width; ++j) sums[0][j].subtract_product(below[j], there);
  }
  MESHORDER_UNROLL
  for (int j = 0; j < Width; ++j) {
    MESHORDER_UNROLL
    for (int k = 1; k < kSums; ++k) sums[0][j] += sums[k][j];
  }
  const Real* left = values + kTriangle;
  MESHORDER_UNROLL
  for (int i = Width - 1; i >= 0; --i) {
    left -= i;
    sums[0][i].store(own + kPaddedStride * i);
    MESHORDER_UNROLL
    for (int j = 0; j < i; ++j) sums[0][j].subtract_product(left[j], sums[0][i]);
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
