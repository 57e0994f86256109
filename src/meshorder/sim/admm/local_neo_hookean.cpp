// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/admm/local_pass.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "meshorder/sim/admm/local_neo_hookean.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include <meshorder/sim/admm/hyperelastic_laws-inl.hpp>
#include <meshorder/sim/admm/proximal-inl.hpp>
#include <meshorder/sim/admm/tetrahedra-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

template <class Lanes>
using Step = ProximalStep<Lanes, NeoHookeanSteps<Lanes>>;

void pass_doubles(const LocalPass<double>& pass) { pass_tetrahedra<ManyLanes, Step<ManyLanes>>(pass); }
void pass_floats(const LocalPass<float>& pass) {
  pass_tetrahedra<ManyFloatLanes, Step<ManyFloatLanes>>(pass);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshorder {
namespace {

HWY_EXPORT(pass_doubles);
HWY_EXPORT(pass_floats);

}  // namespace

void pass_neo_hookean(const LocalPass<double>& pass) { HWY_DYNAMIC_DISPATCH(pass_doubles)(pass); }
void pass_neo_hookean(const LocalPass<float>& pass) { HWY_DYNAMIC_DISPATCH(pass_floats)(pass); }

}  // namespace meshorder
#endif
