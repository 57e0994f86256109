// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set: Highway's foreach_target.h compiles the including file repeatedly.
#if defined(MESHORDER_LANE_BITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_LANE_BITS_INL
#undef MESHORDER_LANE_BITS_INL
#else
#define MESHORDER_LANE_BITS_INL
#endif

#include "kernels/lanes-inl.hpp"
#include "lab/contact/search/tetrahedron_leaves.hpp"

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// As many of a leaf's floats as a register holds.
using Floats = hn::CappedTag<float, kLeaf>;
inline constexpr Index kFloats = static_cast<Index>(MaxLanes(Floats()));

/// Returns a mask of at most 16 lanes as bits, the first lane as the lowest bit.
template <class D, class Mask>
HWY_INLINE std::uint32_t bits_of(D d, Mask mask) {
  alignas(8) std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  if constexpr (MaxLanes(D()) <= 8) return bytes[0];
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8U;
}

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
