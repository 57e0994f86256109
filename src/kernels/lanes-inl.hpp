// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set: Highway's foreach_target.h compiles the including file repeatedly.
#if defined(MESHORDER_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_LANES_INL
#undef MESHORDER_LANES_INL
#else
#define MESHORDER_LANES_INL
#endif

#include "kernels/positions.hpp"
#include "kernels/simplices.hpp"

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <cmath>

/// Unrolls the next loop over rows, columns or corners: otherwise GCC keeps small matrices in memory.
#undef MESHORDER_UNROLL
#define MESHORDER_UNROLL _Pragma("GCC unroll 16")

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Prefetches `Bytes` of an array that is read from front to back. Some processors do not prefetch such an
/// array while a kernel gathers from other arrays (docs/evidence/benchmarks.md, Streams).
template <Offset Bytes>
HWY_INLINE void fetch_stream(const void* place) {
  constexpr Offset kLine = 64;
  for (Offset at = 0; at < Bytes; at += kLine) hwy::Prefetch(static_cast<const char*>(place) + at);
}

/// Lanes for one simplex at a time: the scalar reference.
template <class Real>
struct OneLaneOf {
  using Number = Real;
  using Value = Real;
  static constexpr Index kCount = 1;

  static HWY_INLINE Value set(double value) { return static_cast<Real>(value); }
  static HWY_INLINE Value load(const Real* from) { return *from; }
  static HWY_INLINE void store(Value value, Real* to) { *to = value; }
  static HWY_INLINE Value mul_add(Value a, Value b, Value c) { return a * b + c; }
  static HWY_INLINE Value square_root(Value a) { return std::sqrt(a); }
  /// Returns `where > 0 ? value : 0` for each lane.
  static HWY_INLINE Value if_positive(Value where, Value value) { return where > 0 ? value : 0; }
  /// Returns `where > 0 ? yes : no` for each lane.
  static HWY_INLINE Value choose(Value where, Value yes, Value no) { return where > 0 ? yes : no; }
  static HWY_INLINE Value max(Value a, Value b) { return a > b ? a : b; }
  static HWY_INLINE Value min(Value a, Value b) { return a < b ? a : b; }
  static HWY_INLINE Value abs(Value a) { return std::abs(a); }
  static HWY_INLINE Value with_sign_of(Value value, Value sign) { return std::copysign(value, sign); }
  static HWY_INLINE Value log(Value a) { return std::log(a); }
  /// Returns whether every lane is at most the bound; false if a lane is NaN.
  static HWY_INLINE bool all_at_most(Value a, double bound) { return a <= static_cast<Real>(bound); }
  /// Returns the sum of the lanes.
  static HWY_INLINE Real sum(Value a) { return a; }
  /// Stores lane l of all kCount rows, one after another, from to[l · stride] on.
  static HWY_INLINE void store_transposed(const Value* rows, Real* to, Offset /*stride*/) { *to = *rows; }
  /// Loads the three coordinates of vertex v[0] into p.
  static HWY_INLINE void gather(const Real* positions, const Index* v, Value (&p)[3]) {
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) p[c] = positions[Offset{kPaddedStride} * v[0] + c];
  }
  static HWY_INLINE void scatter_add(const Value (&f)[3], const Index* v, Real* forces) {
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) forces[Offset{kPaddedStride} * v[0] + c] += f[c];
  }

  /// The following members correspond to the members of RowLanes.
  static constexpr Index kRegisters = 3;
  static HWY_INLINE void difference(const Real* positions, Index from, Index to, Value (&row)[kRegisters]) {
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c)
      row[c] = positions[Offset{kPaddedStride} * to + c] - positions[Offset{kPaddedStride} * from + c];
  }
  static HWY_INLINE Value squared_lengths(const Value (&rows)[1][kRegisters]) {
    return rows[0][0] * rows[0][0] + rows[0][1] * rows[0][1] + rows[0][2] * rows[0][2];
  }
  static HWY_INLINE void add(const Value (&row)[kRegisters], Real* forces, Index v) {
    scatter_add(row, &v, forces);
  }
  static HWY_INLINE void subtract(const Value (&row)[kRegisters], Real* forces, Index v) {
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) forces[Offset{kPaddedStride} * v + c] -= row[c];
  }
};

using OneLane = OneLaneOf<double>;

#if HWY_TARGET == HWY_SCALAR
using ManyLanes = OneLane;
using RowLanes = OneLane;
#else
/// Arithmetic on as many numbers at a time as a register holds, at most `Most`.
template <class Real, Index Most>
struct LaneArithmetic {
  using Number = Real;
  using Tag = hn::CappedTag<Number, Most>;
  using Value = hn::Vec<Tag>;
  static constexpr Index kCount = static_cast<Index>(MaxLanes(Tag()));

  static HWY_INLINE Value set(double value) { return hn::Set(Tag(), static_cast<Number>(value)); }
  static HWY_INLINE Value load(const Number* from) { return hn::Load(Tag(), from); }
  static HWY_INLINE void store(Value value, Number* to) { hn::Store(value, Tag(), to); }
  static HWY_INLINE Value mul_add(Value a, Value b, Value c) { return hn::MulAdd(a, b, c); }
  static HWY_INLINE Value square_root(Value a) { return hn::Sqrt(a); }
  static HWY_INLINE Value if_positive(Value where, Value value) {
    return hn::IfThenElseZero(hn::Gt(where, hn::Zero(Tag())), value);
  }
  static HWY_INLINE Value choose(Value where, Value yes, Value no) {
    return hn::IfThenElse(hn::Gt(where, hn::Zero(Tag())), yes, no);
  }
  static HWY_INLINE Value max(Value a, Value b) { return hn::Max(a, b); }
  static HWY_INLINE Value min(Value a, Value b) { return hn::Min(a, b); }
  static HWY_INLINE Value abs(Value a) { return hn::Abs(a); }
  static HWY_INLINE Value with_sign_of(Value value, Value sign) { return hn::CopySign(value, sign); }
  static HWY_INLINE Value log(Value a) {
    alignas(64) Number lanes[kCount];
    store(a, lanes);
    for (Number& lane : lanes) lane = std::log(lane);
    return load(lanes);
  }
  static HWY_INLINE bool all_at_most(Value a, double bound) {
    return hn::AllTrue(Tag(), hn::Le(a, set(bound)));
  }
  static HWY_INLINE Number sum(Value a) { return hn::GetLane(hn::SumOfLanes(Tag(), a)); }

 protected:
  template <class T>
  static HWY_INLINE T* at(T* vectors, Index v) {
    return vectors + Offset{kPaddedStride} * v;
  }

  template <class D>
  static HWY_INLINE void add_to(D d, hn::Vec<D> value, Real* place) {
    hn::Store(hn::Add(hn::Load(d, place), value), d, place);
  }

  /// Loads the padded coordinates of v[0], v[4] … side by side.
  template <class D>
  static HWY_INLINE hn::Vec<D> load_fourth(D d, const Real* positions, const Index* v) {
    if constexpr (MaxLanes(D()) <= kPaddedStride) {
      return hn::Load(d, at(positions, v[0]));
    } else {
      const hn::Half<D> half;
      return hn::Combine(d, load_fourth(half, positions, v + MaxLanes(half)),
                         load_fourth(half, positions, v));
    }
  }

  template <class D>
  static HWY_INLINE void add_fourth(D d, hn::Vec<D> vectors, const Index* v, Real* forces) {
    if constexpr (MaxLanes(D()) <= kPaddedStride) {
      add_to(d, vectors, at(forces, v[0]));
    } else {
      const hn::Half<D> half;
      add_fourth(half, hn::LowerHalf(half, vectors), v, forces);
      add_fourth(half, hn::UpperHalf(half, vectors), v + MaxLanes(half), forces);
    }
  }
};

/// Lanes for as many simplices as a register holds doubles, at most a batch.
struct ManyLanes : LaneArithmetic<double, kBatch> {
  static HWY_INLINE void store_transposed(const Value* rows, double* to, Offset stride) {
    const Tag d;
    if constexpr (kCount == 2) {
      store(hn::InterleaveLower(d, rows[0], rows[1]), to);
      store(hn::InterleaveUpper(d, rows[0], rows[1]), to + stride);
    } else {
      Value even[kCount / 2];
      Value odd[kCount / 2];
      MESHORDER_UNROLL
      for (Index i = 0; i < kCount / 2; ++i) {
        even[i] = hn::InterleaveLower(d, rows[2 * i], rows[2 * i + 1]);
        odd[i] = hn::InterleaveUpper(d, rows[2 * i], rows[2 * i + 1]);
      }
      store_blocks_transposed(even, to, 2 * stride);
      store_blocks_transposed(odd, to + stride, 2 * stride);
    }
  }

  /// Loads the coordinates of the vertices v[0] … v[kCount − 1] into p, by loads and a transposition: gather
  /// instructions were slower on all machines measured.
  static HWY_INLINE void gather(const double* positions, const Index* v, Value (&p)[3]) {
    const Tag d;
    if constexpr (kCount == 2) {
      const Value xy0 = hn::Load(d, at(positions, v[0]));
      const Value xy1 = hn::Load(d, at(positions, v[1]));
      p[0] = hn::InterleaveLower(d, xy0, xy1);
      p[1] = hn::InterleaveUpper(d, xy0, xy1);
      p[2] =
          hn::InterleaveLower(d, hn::Load(d, at(positions, v[0]) + 2), hn::Load(d, at(positions, v[1]) + 2));
    } else {
      // blocks of two doubles: x₀x₁ z₀z₁ x₄x₅ z₄z₅, x₂x₃ z₂z₃ x₆x₇ z₆z₇, and likewise for y and the padding
      const Value v0 = load_fourth(d, positions, v);
      const Value v1 = load_fourth(d, positions, v + 1);
      const Value v2 = load_fourth(d, positions, v + 2);
      const Value v3 = load_fourth(d, positions, v + 3);
      const Value xz01 = hn::InterleaveLower(d, v0, v1);
      const Value xz23 = hn::InterleaveLower(d, v2, v3);
      const Value yw01 = hn::InterleaveUpper(d, v0, v1);
      const Value yw23 = hn::InterleaveUpper(d, v2, v3);
      p[0] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(xz23), xz01);
      p[1] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(yw23), yw01);
      p[2] = hn::OddEvenBlocks(xz23, hn::SwapAdjacentBlocks(xz01));
    }
  }

  /// Adds f to the forces of v[0] … v[kCount − 1], among which a vertex may occur several times.
  static HWY_INLINE void scatter_add(const Value (&f)[3], const Index* v, double* forces) {
    const Tag d;
    const Value xy_even = hn::InterleaveLower(d, f[0], f[1]);
    const Value xy_odd = hn::InterleaveUpper(d, f[0], f[1]);
    const Value z_even = hn::InterleaveLower(d, f[2], hn::Zero(d));
    const Value z_odd = hn::InterleaveUpper(d, f[2], hn::Zero(d));
    if constexpr (kCount == 2) {
      add_to(d, xy_even, at(forces, v[0]));
      add_to(d, z_even, at(forces, v[0]) + 2);
      add_to(d, xy_odd, at(forces, v[1]));
      add_to(d, z_odd, at(forces, v[1]) + 2);
    } else {
      add_fourth(d, hn::OddEvenBlocks(hn::SwapAdjacentBlocks(z_even), xy_even), v, forces);
      add_fourth(d, hn::OddEvenBlocks(hn::SwapAdjacentBlocks(z_odd), xy_odd), v + 1, forces);
      add_fourth(d, hn::OddEvenBlocks(z_even, hn::SwapAdjacentBlocks(xy_even)), v + 2, forces);
      add_fourth(d, hn::OddEvenBlocks(z_odd, hn::SwapAdjacentBlocks(xy_odd)), v + 3, forces);
    }
  }

 private:
  /// As store_transposed, with blocks of two doubles in place of doubles.
  static HWY_INLINE void store_blocks_transposed(const Value* rows, double* to, Offset stride) {
    const Tag d;
    const Value even01 = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(rows[1]), rows[0]);
    const Value odd01 = hn::OddEvenBlocks(rows[1], hn::SwapAdjacentBlocks(rows[0]));
    if constexpr (kCount == 4) {
      store(even01, to);
      store(odd01, to + stride);
    } else {
      const Value even23 = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(rows[3]), rows[2]);
      const Value odd23 = hn::OddEvenBlocks(rows[3], hn::SwapAdjacentBlocks(rows[2]));
      store(hn::ConcatLowerLower(d, even23, even01), to);
      store(hn::ConcatLowerLower(d, odd23, odd01), to + stride);
      store(hn::ConcatUpperUpper(d, even23, even01), to + 2 * stride);
      store(hn::ConcatUpperUpper(d, odd23, odd01), to + 3 * stride);
    }
  }
};

/// Lanes for kernels that need only the lengths of vectors, without the transpositions of ManyLanes. A
/// vertex's vector (x, y, z and the padding) is in one register or in two; a Value holds one number for each
/// of kCount vectors.
struct RowLanes : LaneArithmetic<double, kPaddedStride> {
  static constexpr Index kRegisters = kPaddedStride / kCount;  ///< registers per vector

  /// Sets row to x_to − x_from.
  static HWY_INLINE void difference(const double* positions, Index from, Index to, Value (&row)[kRegisters]) {
    const Tag d;
    MESHORDER_UNROLL
    for (Index r = 0; r < kRegisters; ++r)
      row[r] = hn::Load(d, at(positions, to) + r * kCount) - hn::Load(d, at(positions, from) + r * kCount);
  }

  static HWY_INLINE Value squared_lengths(const Value (&rows)[kCount][kRegisters]) {
    const Tag d;
    Value squares[kCount];  // kRegisters = 1: x², y², z² and the padding's; 2: x² + z², y² + the padding's
    MESHORDER_UNROLL
    for (Index i = 0; i < kCount; ++i) {
      squares[i] = rows[i][0] * rows[i][0];
      if constexpr (kRegisters == 2) squares[i] = mul_add(rows[i][1], rows[i][1], squares[i]);
    }
    const Value sums01 =
        hn::InterleaveLower(d, squares[0], squares[1]) + hn::InterleaveUpper(d, squares[0], squares[1]);
    if constexpr (kCount == 2) {
      return sums01;
    } else {
      const Value sums23 =
          hn::InterleaveLower(d, squares[2], squares[3]) + hn::InterleaveUpper(d, squares[2], squares[3]);
      return hn::ConcatLowerLower(d, sums23, sums01) + hn::ConcatUpperUpper(d, sums23, sums01);
    }
  }

  /// Adds row to the force on vertex v.
  static HWY_INLINE void add(const Value (&row)[kRegisters], double* forces, Index v) {
    MESHORDER_UNROLL
    for (Index r = 0; r < kRegisters; ++r) add_to(Tag(), row[r], at(forces, v) + r * kCount);
  }

  /// Subtracts row from the force on vertex v.
  static HWY_INLINE void subtract(const Value (&row)[kRegisters], double* forces, Index v) {
    const Tag d;
    MESHORDER_UNROLL
    for (Index r = 0; r < kRegisters; ++r) {
      double* const place = at(forces, v) + r * kCount;
      store(hn::Load(d, place) - row[r], place);
    }
  }
};
#endif

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
