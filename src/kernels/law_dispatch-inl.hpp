// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The kernels of one elastic law for all instruction sets. A law's .cpp file includes this file at its end,
// once for each instruction set. Before the include it defines MESHORDER_LAW_KERNELS, the name of the
// function of pass.hpp that returns these kernels, and in meshorder::HWY_NAMESPACE a struct LawOfFile with
//   Law<D, Lanes>, ExactTangent<D, Lanes>, ApproximateTangent<D, Lanes>: see add_batch;
//   kVolumesOnly: whether the law supports only tetrahedra.
// A law without an approximate tangent sets ApproximateTangent to its ExactTangent.
#include "kernels/batches-inl.hpp"
#include "kernels/projected-inl.hpp"

HWY_BEFORE_NAMESPACE();
// NOLINTBEGIN(misc-definitions-in-headers): each source that includes this defines one law
namespace meshorder::HWY_NAMESPACE {
namespace {

template <int D, class Lanes>
HWY_INLINE void add_dimension(const ElasticPass& pass) {
  using Law = LawOfFile::Law<D, Lanes>;
  using Exact = LawOfFile::ExactTangent<D, Lanes>;
  using Approximate = LawOfFile::ApproximateTangent<D, Lanes>;
  if (!pass.values) return add_batches<D, Lanes, Law, NoTangent>(pass);
  if constexpr (D == 3) {
    if (pass.tangent == Tangent::projected)
      return add_batches<D, Lanes, Law, ProjectedTangent<Lanes, Law>>(pass);
  }
  if constexpr (!std::is_same_v<Approximate, Exact>) {
    if (pass.tangent == Tangent::approximate) return add_batches<D, Lanes, Law, Approximate>(pass);
  }
  add_batches<D, Lanes, Law, Exact>(pass);
}

template <class Lanes>
HWY_INLINE void add_any(const ElasticPass& pass) {
  if constexpr (LawOfFile::kVolumesOnly) {
    add_dimension<3, Lanes>(pass);
  } else {
    if (pass.rest.dimension == 3) add_dimension<3, Lanes>(pass);
    if (pass.rest.dimension == 2) add_dimension<2, Lanes>(pass);
    if (pass.rest.dimension == 1) add_dimension<1, Lanes>(pass);
  }
}

void add(const ElasticPass& pass) { add_any<ManyLanes>(pass); }

template <int D, class Lanes>
HWY_INLINE double energy_of(const ElasticPass& pass, Index begin, Index end) {
  return energy_of_batches<D, Lanes, LawOfFile::Law<D, Lanes>>(pass, begin, end);
}

template <class Lanes>
HWY_INLINE double energy_any(const ElasticPass& pass, Index begin, Index end) {
  if constexpr (LawOfFile::kVolumesOnly) {
    return energy_of<3, Lanes>(pass, begin, end);
  } else {
    if (pass.rest.dimension == 3) return energy_of<3, Lanes>(pass, begin, end);
    if (pass.rest.dimension == 2) return energy_of<2, Lanes>(pass, begin, end);
    if (pass.rest.dimension == 1) return energy_of<1, Lanes>(pass, begin, end);
    return 0.0;
  }
}

double energy(const ElasticPass& pass, Index begin, Index end) {
  return energy_any<ManyLanes>(pass, begin, end);
}

#if HWY_ONCE
void add_one_by_one(const ElasticPass& pass) { add_any<OneLane>(pass); }
#endif

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(add);
MESHORDER_SIMD_VERSIONS(energy);

}  // namespace

ElasticKernels MESHORDER_LAW_KERNELS() {
  return {MESHORDER_SIMD(add), HWY_STATIC_DISPATCH(add_one_by_one), MESHORDER_SIMD(energy)};
}

}  // namespace meshorder
#endif
// NOLINTEND(misc-definitions-in-headers)
