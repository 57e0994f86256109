// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/local_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/admm/local_hyperelastic.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "lab/admm/hyperelastic_laws-inl.hpp"
#include "lab/admm/proximal-inl.hpp"
#include "lab/admm/tetrahedra-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

template <template <class> class Law>
void doubles(const LocalPass<double>& pass) {
  pass_tetrahedra<ManyLanes, ProximalStep<ManyLanes, Law<ManyLanes>>>(pass);
}
template <template <class> class Law>
void floats(const LocalPass<float>& pass) {
  pass_tetrahedra<ManyFloatLanes, ProximalStep<ManyFloatLanes, Law<ManyFloatLanes>>>(pass);
}

void stvk_doubles(const LocalPass<double>& pass) { doubles<StvkSteps>(pass); }
void stvk_floats(const LocalPass<float>& pass) { floats<StvkSteps>(pass); }
void neo_hookean_doubles(const LocalPass<double>& pass) { doubles<NeoHookeanSteps>(pass); }
void neo_hookean_floats(const LocalPass<float>& pass) { floats<NeoHookeanSteps>(pass); }
void log_neo_hookean_doubles(const LocalPass<double>& pass) { doubles<LogNeoHookeanSteps>(pass); }
void log_neo_hookean_floats(const LocalPass<float>& pass) { floats<LogNeoHookeanSteps>(pass); }

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {

MESHORDER_EXPORT_LOCAL_PASS(stvk)
MESHORDER_EXPORT_LOCAL_PASS(neo_hookean)
MESHORDER_EXPORT_LOCAL_PASS(log_neo_hookean)

}  // namespace meshorder
#endif
