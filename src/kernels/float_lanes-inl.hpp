// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_FLOAT_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_FLOAT_LANES_INL
#undef MESHORDER_FLOAT_LANES_INL
#else
#define MESHORDER_FLOAT_LANES_INL
#endif

#include "kernels/lanes-inl.hpp"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
using ManyFloatLanes = OneLaneOf<float>;
#else
/// Lanes for as many simplices as a register holds floats, at most two batches; see ManyLanes.
struct ManyFloatLanes : LaneArithmetic<float, 2 * kBatch> {
  static HWY_INLINE void gather(const float* positions, const Index* v, Value (&p)[3]) {
    const Tag d;
    const hn::Repartition<double, Tag> pairs;
    // a vertex is a block of four floats: blocks of vertices k, k + 4, … are transposed side by side
    const Value xy01 = hn::InterleaveLower(d, load_fourth(d, positions, v), load_fourth(d, positions, v + 1));
    const Value zw01 = hn::InterleaveUpper(d, load_fourth(d, positions, v), load_fourth(d, positions, v + 1));
    const Value xy23 =
        hn::InterleaveLower(d, load_fourth(d, positions, v + 2), load_fourth(d, positions, v + 3));
    const Value zw23 =
        hn::InterleaveUpper(d, load_fourth(d, positions, v + 2), load_fourth(d, positions, v + 3));
    p[0] = hn::BitCast(d, hn::InterleaveLower(pairs, hn::BitCast(pairs, xy01), hn::BitCast(pairs, xy23)));
    p[1] = hn::BitCast(d, hn::InterleaveUpper(pairs, hn::BitCast(pairs, xy01), hn::BitCast(pairs, xy23)));
    p[2] = hn::BitCast(d, hn::InterleaveLower(pairs, hn::BitCast(pairs, zw01), hn::BitCast(pairs, zw23)));
  }

  /// Adds f to the forces of v[0] … v[kCount − 1], among which a vertex may occur several times.
  static HWY_INLINE void scatter_add(const Value (&f)[3], const Index* v, float* forces) {
    const Tag d;
    const hn::Repartition<double, Tag> pairs;
    const auto xy01 = hn::BitCast(pairs, hn::InterleaveLower(d, f[0], f[1]));
    const auto xy23 = hn::BitCast(pairs, hn::InterleaveUpper(d, f[0], f[1]));
    const auto zw01 = hn::BitCast(pairs, hn::InterleaveLower(d, f[2], hn::Zero(d)));
    const auto zw23 = hn::BitCast(pairs, hn::InterleaveUpper(d, f[2], hn::Zero(d)));
    add_fourth(d, hn::BitCast(d, hn::InterleaveLower(pairs, xy01, zw01)), v, forces);
    add_fourth(d, hn::BitCast(d, hn::InterleaveUpper(pairs, xy01, zw01)), v + 1, forces);
    add_fourth(d, hn::BitCast(d, hn::InterleaveLower(pairs, xy23, zw23)), v + 2, forces);
    add_fourth(d, hn::BitCast(d, hn::InterleaveUpper(pairs, xy23, zw23)), v + 3, forces);
  }
};
#endif

/// The lanes for numbers of type Real.
template <class Real>
using ManyLanesOf = std::conditional_t<std::is_same_v<Real, float>, ManyFloatLanes, ManyLanes>;

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
