// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/kernels/element_force.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "meshorder/sim/kernels/element_force.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include <meshorder/sim/kernels/stvk-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// A batch of simplices, which adds to `targets`: its vertices, or spare ones in place of them.
template <int D, class Lanes>
HWY_INLINE void add_batch(const double* geometry, const Index* vertices, const Index* targets,
                          const Lame& lame, const double* positions, double* forces) {
  for (Index lane = 0; lane < kBatch; lane += Lanes::kCount) {
    OldStvk<D, Lanes> stvk;
    stvk.load(geometry + lane, vertices + lane, positions);
    stvk.strain_and_stress(lame);
    stvk.add_forces(targets + lane, forces);
  }
}

/// All batches, or those of a share.
template <int D, class Lanes>
HWY_INLINE void add_forces(const RestShapes& rest, const Lame& lame, const double* positions, double* forces,
                           const OwnedBatches* share) {
  constexpr Offset kGeometry = kBatch * (D * (D + 1) / 2 + 1);
  constexpr Offset kVertices = kBatch * (D + 1);
  const Offset count = share ? static_cast<Offset>(share->batches.size()) : rest.batches();
  for (Offset i = 0; i < count; ++i) {
    const Offset batch = share ? share->batches[i] : i;
    const Index* const vertices = rest.vertices.data() + kVertices * batch;
    add_batch<D, Lanes>(rest.geometry.data() + kGeometry * batch, vertices,
                        share ? share->targets_of(i, vertices, D + 1) : vertices, lame, positions, forces);
  }
}

template <class Lanes>
HWY_INLINE void add_forces_of_any(const RestShapes& rest, const Lame& lame, const double* positions,
                                  double* forces, const OwnedBatches* share) {
  if (rest.dimension == 3) add_forces<3, Lanes>(rest, lame, positions, forces, share);
  if (rest.dimension == 2) add_forces<2, Lanes>(rest, lame, positions, forces, share);
  if (rest.dimension == 1) add_forces<1, Lanes>(rest, lame, positions, forces, share);
}

void add_forces_in_batches(const RestShapes& rest, const Lame& lame, const double* positions, double* forces,
                           const OwnedBatches* share) {
  add_forces_of_any<ManyLanes>(rest, lame, positions, forces, share);
}

#if HWY_ONCE
void add_forces_one_by_one(const RestShapes& rest, const Lame& lame, const double* positions,
                           double* forces) {
  add_forces_of_any<OneLane>(rest, lame, positions, forces, nullptr);
}

template <int D>
double energy_of_all(const RestShapes& rest, const Lame& lame, const double* positions) {
  double sum = 0.0;
  for (Offset s = 0; s < rest.count; ++s) {
    OldStvk<D, OneLane> stvk;
    stvk.load(rest.geometry.data() + s / kBatch * kBatch * rest.quantities() + s % kBatch,
              rest.vertices.data() + s / kBatch * kBatch * (D + 1) + s % kBatch, positions);
    stvk.strain_and_stress(lame);
    sum += stvk.energy(lame);
  }
  return sum;
}

double energy(const RestShapes& rest, const Lame& lame, const double* positions) {
  switch (rest.dimension) {
    case 3:
      return energy_of_all<3>(rest, lame, positions);
    case 2:
      return energy_of_all<2>(rest, lame, positions);
    case 1:
      return energy_of_all<1>(rest, lame, positions);
    default:
      return 0.0;
  }
}
#endif

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshorder {
namespace {

HWY_EXPORT(add_forces_in_batches);

}  // namespace

double stvk_energy(const RestShapes& rest, const Lame& lame, std::span<const double> positions) {
  return HWY_STATIC_DISPATCH(energy)(rest, lame, positions.data());
}

void add_stvk_forces(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                     std::span<double> forces) {
  check_same_size(positions, forces, "add_stvk_forces");
  HWY_DYNAMIC_DISPATCH(add_forces_in_batches)(rest, lame, positions.data(), forces.data(), nullptr);
}

void add_stvk_forces(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                     std::span<double> forces, const OwnedBatches& share) {
  check_room(forces, share, "add_stvk_forces");
  HWY_DYNAMIC_DISPATCH(add_forces_in_batches)(rest, lame, positions.data(), forces.data(), &share);
}

void add_stvk_forces_scalar(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                            std::span<double> forces) {
  check_same_size(positions, forces, "add_stvk_forces");
  HWY_STATIC_DISPATCH(add_forces_one_by_one)(rest, lame, positions.data(), forces.data());
}

}  // namespace meshorder
#endif
