// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/stvk.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include "kernels/batches-inl.hpp"
#include "kernels/stvk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

template <int D, class Lanes>
HWY_INLINE void add_dimension(const ElasticPass& pass) {
  using Law = Stvk<D, Lanes>;
  if (!pass.values) return add_batches<D, Lanes, Law, NoTangent>(pass);
  if constexpr (D == 3) {
    if (pass.tangent == Tangent::projected) {
      return add_batches<3, Lanes, Law, ProjectedTangent<Lanes, Law>>(pass);
    }
  }
  add_batches<D, Lanes, Law, StvkTangent<D, Lanes>>(pass);
}

template <class Lanes>
HWY_INLINE void add_any(const ElasticPass& pass) {
  if (pass.rest.dimension == 3) add_dimension<3, Lanes>(pass);
  if (pass.rest.dimension == 2) add_dimension<2, Lanes>(pass);
  if (pass.rest.dimension == 1) add_dimension<1, Lanes>(pass);
}

void add(const ElasticPass& pass) { add_any<ManyLanes>(pass); }

double energy(const ElasticPass& pass, Index begin, Index end) {
  if (pass.rest.dimension == 3) return energy_of_batches<3, ManyLanes, Stvk<3, ManyLanes>>(pass, begin, end);
  if (pass.rest.dimension == 2) return energy_of_batches<2, ManyLanes, Stvk<2, ManyLanes>>(pass, begin, end);
  if (pass.rest.dimension == 1) return energy_of_batches<1, ManyLanes, Stvk<1, ManyLanes>>(pass, begin, end);
  return 0.0;
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

ElasticKernels stvk_kernels() {
  return {HWY_DYNAMIC_DISPATCH(add), HWY_STATIC_DISPATCH(add_one_by_one), HWY_DYNAMIC_DISPATCH(energy)};
}

}  // namespace meshorder
#endif
