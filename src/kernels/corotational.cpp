// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/corotational.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include "kernels/batches-inl.hpp"
#include "kernels/corotational-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

template <class Lanes>
HWY_INLINE void add_any(const ElasticPass& pass) {
  using Law = Corotational<Lanes>;
  if (!pass.values) return add_batches<3, Lanes, Law, NoTangent>(pass);
  if (pass.tangent == Tangent::projected) {
    return add_batches<3, Lanes, Law, ProjectedTangent<Lanes, Law>>(pass);
  }
  if (pass.tangent == Tangent::approximate) {
    return add_batches<3, Lanes, Law, TurnedTangent<Lanes>>(pass);
  }
  add_batches<3, Lanes, Law, CorotationalTangent<Lanes>>(pass);
}

void add(const ElasticPass& pass) { add_any<ManyLanes>(pass); }

double energy(const ElasticPass& pass, Index begin, Index end) {
  return energy_of_batches<3, ManyLanes, Corotational<ManyLanes>>(pass, begin, end);
}

#if HWY_ONCE
void add_one_by_one(const ElasticPass& pass) { add_any<OneLane>(pass); }
#endif

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshorder {
namespace {

HWY_EXPORT(add);
HWY_EXPORT(energy);

}  // namespace

ElasticKernels corotational_kernels() {
  return {HWY_DYNAMIC_DISPATCH(add), HWY_STATIC_DISPATCH(add_one_by_one), HWY_DYNAMIC_DISPATCH(energy)};
}

}  // namespace meshorder
#endif
