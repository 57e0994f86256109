// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cholesky/panel_sweeps.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/linear/cholesky/panel_sweeps.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "lab/linear/cg/vertices-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

constexpr int kGroup = Panel::kGroup;
static_assert(kGroup % Vertices<double>::kCount == 0 && kGroup % Vertices<float>::kCount == 0);

/// Computes y = L⁻¹ x for the columns of a panel, where `own` is x; then sets `own` to D⁻¹ y.
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

struct Forwards {
  template <int Width, class Real>
  static HWY_INLINE void run(const Index* rows, Index row_count, const Real* values, Real* own, Real* x) {
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
};

/// Prefetches the numbers 4 KB before `values`; hardware hardly prefetches descending addresses.
template <int Bytes, class Real>
HWY_INLINE void ask_for_those_before(const Real* values) {
  constexpr int kBytesAhead = 4096;
  MESHORDER_UNROLL
  for (int line = 0; line < Bytes; line += 64) {
    __builtin_prefetch(reinterpret_cast<const char*>(values) + line - kBytesAhead);
  }
}

struct Backwards {
  template <int Width, class Real>
  static HWY_INLINE void run(const Index* rows, Index row_count, const Real* values, Real* own,
                             const Real* x) {
    using Several = Vertices<Real>;
    constexpr int kTriangle = Width * (Width - 1) / 2;
    // rows alternate between sums, since additions to one sum depend on each other
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
};

/// Sweeps over one panel by Sweep::run<its width>.
template <class Sweep, class Real>
HWY_INLINE void sweep(const PanelView<Real>& view, const Panel& panel, Real* x) {
  const Index* const rows = view.rows + panel.rows;
  const Real* const values = view.values + panel.values;
  Real* const own = at(x, panel.column);
  static_assert(Panel::kWidest == 8);
  switch (panel.width) {
    case 1:
      return Sweep::template run<1>(rows, panel.row_count, values, own, x);
    case 2:
      return Sweep::template run<2>(rows, panel.row_count, values, own, x);
    case 3:
      return Sweep::template run<3>(rows, panel.row_count, values, own, x);
    case 4:
      return Sweep::template run<4>(rows, panel.row_count, values, own, x);
    case 5:
      return Sweep::template run<5>(rows, panel.row_count, values, own, x);
    case 6:
      return Sweep::template run<6>(rows, panel.row_count, values, own, x);
    case 7:
      return Sweep::template run<7>(rows, panel.row_count, values, own, x);
    default:
      return Sweep::template run<8>(rows, panel.row_count, values, own, x);
  }
}

template <class Real>
HWY_INLINE void forwards(const PanelView<Real>& view, const PanelRange& range, Real* x) {
  for (Index k = 0; k < range.count; ++k) sweep<Forwards>(view, view.panels[range[k]], x);
}

template <class Real>
HWY_INLINE void backwards(const PanelView<Real>& view, const PanelRange& range, Real* x) {
  for (Index k = range.count - 1; k >= 0; --k) sweep<Backwards>(view, view.panels[range[k]], x);
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

#include "kernels/simd_dispatch.hpp"

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(forwards_of_doubles);
MESHORDER_SIMD_VERSIONS(forwards_of_floats);
MESHORDER_SIMD_VERSIONS(backwards_of_doubles);
MESHORDER_SIMD_VERSIONS(backwards_of_floats);

}  // namespace

void sweep_forwards(const PanelView<double>& view, const PanelRange& range, double* x) {
  MESHORDER_SIMD(forwards_of_doubles)(view, range, x);
}

void sweep_forwards(const PanelView<float>& view, const PanelRange& range, float* x) {
  MESHORDER_SIMD(forwards_of_floats)(view, range, x);
}

void sweep_backwards(const PanelView<double>& view, const PanelRange& range, double* x) {
  MESHORDER_SIMD(backwards_of_doubles)(view, range, x);
}

void sweep_backwards(const PanelView<float>& view, const PanelRange& range, float* x) {
  MESHORDER_SIMD(backwards_of_floats)(view, range, x);
}

}  // namespace meshorder
#endif
