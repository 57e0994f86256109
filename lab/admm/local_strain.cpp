// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/local_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/admm/local_strain.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/rotation-inl.hpp"
#include "lab/admm/tetrahedra-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// U = ½w²‖F − R‖², whose step goes halfway to the closest rotation.
template <class Lanes>
struct LinearStrain {
  using Value = typename Lanes::Value;

  HWY_INLINE explicit LinearStrain(const typename Lanes::Number* /*softness*/) {}

  HWY_INLINE void step(const Value (&q)[3][3], Value (&z)[3][3]) const {
    closest_rotations<Lanes>(q, z);
    MESHORDER_UNROLL
    for (int k = 0; k < 9; ++k) z[k / 3][k % 3] = Lanes::set(0.5) * (q[k / 3][k % 3] + z[k / 3][k % 3]);
  }
};

void strain_doubles(const LocalPass<double>& pass) {
  pass_tetrahedra<ManyLanes, LinearStrain<ManyLanes>>(pass);
}
void strain_floats(const LocalPass<float>& pass) {
  pass_tetrahedra<ManyFloatLanes, LinearStrain<ManyFloatLanes>>(pass);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {

MESHORDER_EXPORT_LOCAL_PASS(strain)

}  // namespace meshorder
#endif
