// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/local_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/admm/local_tetrahedra.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/float_lanes-inl.hpp"
#include "kernels/rotation-inl.hpp"
#include "lab/admm/hyperelastic_laws-inl.hpp"
#include "lab/admm/proximal-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// Adds F = Dₛ Dₘ⁻¹ of Lanes::kCount tetrahedra to f.
template <class Lanes>
HWY_INLINE void add_gradients(const typename Lanes::Number* rest, const Index* vertices,
                              const typename Lanes::Number* positions, typename Lanes::Value (&f)[3][3]) {
  using Value = typename Lanes::Value;
  constexpr Index kBatchOf = kLocalBatch<typename Lanes::Number>;
  Value origin[3];
  Lanes::gather(positions, vertices, origin);
  MESHORDER_UNROLL
  for (int a = 0; a < 3; ++a) {
    Value edge[3];
    Lanes::gather(positions, vertices + (a + 1) * kBatchOf, edge);
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) edge[c] = edge[c] - origin[c];
    MESHORDER_UNROLL
    for (int j = 0; j < 3; ++j) {
      const Value g = Lanes::load(rest + (3 * a + j) * kBatchOf);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) f[c][j] = Lanes::mul_add(edge[c], g, f[c][j]);
    }
  }
}

/// Adds Dᵀ P of Lanes::kCount tetrahedra to the vertices.
template <class Lanes>
HWY_INLINE void add_transposed(const typename Lanes::Number* rest, const Index* targets,
                               const typename Lanes::Value (&p)[3][3], typename Lanes::Number* sums) {
  using Value = typename Lanes::Value;
  constexpr Index kBatchOf = kLocalBatch<typename Lanes::Number>;
  Value at_origin[3];
  MESHORDER_UNROLL
  for (int a = 0; a < 3; ++a) {
    Value at_corner[3];
    MESHORDER_UNROLL
    for (int j = 0; j < 3; ++j) {
      const Value g = Lanes::load(rest + (3 * a + j) * kBatchOf);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) {
        at_corner[c] = j == 0 ? p[c][0] * g : Lanes::mul_add(p[c][j], g, at_corner[c]);
      }
    }
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      at_origin[c] = a == 0 ? Lanes::set(0.0) - at_corner[c] : at_origin[c] - at_corner[c];
    }
    Lanes::scatter_add(at_corner, targets + (a + 1) * kBatchOf, sums);
  }
  Lanes::scatter_add(at_origin, targets, sums);
}

/// Takes the local steps of a share's tetrahedra. Law(softness).step(q, z) computes z = argmin U(z) / w² +
/// ½‖z − q‖² for elements of this softness.
template <class Lanes, class Law>
HWY_INLINE void pass_tetrahedra(const LocalPass<typename Lanes::Number>& pass) {
  using Number = typename Lanes::Number;
  using Value = typename Lanes::Value;
  constexpr Index kBatchOf = kLocalBatch<Number>;
  const auto count = static_cast<Offset>(pass.share.batches.size());
  for (Offset i = 0; i < count; ++i) {
    const Offset batch = pass.share.batches[i];
    const Index* const vertices = pass.vertices + 4 * kBatchOf * batch;
    // owned_batches counts in batches of kBatch elements
    const Index* const targets = pass.share.targets_of(i, vertices, 4 * (kBatchOf / kBatch));
    const Number* const rest = pass.rest + kTetrahedronNumbers * kBatchOf * batch;
    Number* const duals = pass.duals + 9 * kBatchOf * i;
    const Number* const softness = pass.softness + pass.softness_stride * batch;
    Value primal = Lanes::set(0.0);
    Value magnitude = Lanes::set(0.0);
    for (Index lane = 0; lane < kBatchOf; lane += Lanes::kCount) {
      Value q[3][3];
      MESHORDER_UNROLL
      for (int k = 0; k < 9; ++k) q[k / 3][k % 3] = Lanes::load(duals + k * kBatchOf + lane);
      add_gradients<Lanes>(rest + lane, vertices + lane, pass.positions, q);
      Value z[3][3];
      Law(softness == nullptr ? nullptr : softness + lane).step(q, z);

      Value changes = Lanes::set(0.0);
      Value squares = Lanes::set(0.0);
      const Value weight = Lanes::load(rest + 9 * kBatchOf + lane);
      const Value factor = Lanes::set(pass.scale) * weight;
      MESHORDER_UNROLL
      for (int k = 0; k < 9; ++k) {
        Value& entry = z[k / 3][k % 3];
        const Value dual = q[k / 3][k % 3] - entry;
        // D x − z
        const Value change = dual - Lanes::load(duals + k * kBatchOf + lane);
        Lanes::store(dual, duals + k * kBatchOf + lane);
        changes = Lanes::mul_add(change, change, changes);
        squares = Lanes::mul_add(entry, entry, squares);
        entry = factor * (entry - dual);
      }
      primal = Lanes::mul_add(weight, changes, primal);
      magnitude = Lanes::mul_add(weight, squares, magnitude);
      add_transposed<Lanes>(rest + lane, targets + lane, z, pass.right_hand_side);
    }
    pass.residuals[2 * i] = static_cast<double>(Lanes::sum(primal));
    pass.residuals[2 * i + 1] = static_cast<double>(Lanes::sum(magnitude));
  }
}

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

template <class Lanes>
using Stvk = ProximalStep<Lanes, StvkSteps<Lanes>>;
template <class Lanes>
using NeoHookean = ProximalStep<Lanes, NeoHookeanSteps<Lanes>>;
template <class Lanes>
using LogNeoHookean = ProximalStep<Lanes, LogNeoHookeanSteps<Lanes>>;

template <template <class> class Law>
void doubles(const LocalPass<double>& pass) {
  pass_tetrahedra<ManyLanes, Law<ManyLanes>>(pass);
}
template <template <class> class Law>
void floats(const LocalPass<float>& pass) {
  pass_tetrahedra<ManyFloatLanes, Law<ManyFloatLanes>>(pass);
}

void strain_doubles(const LocalPass<double>& pass) { doubles<LinearStrain>(pass); }
void strain_floats(const LocalPass<float>& pass) { floats<LinearStrain>(pass); }
void stvk_doubles(const LocalPass<double>& pass) { doubles<Stvk>(pass); }
void stvk_floats(const LocalPass<float>& pass) { floats<Stvk>(pass); }
void neo_hookean_doubles(const LocalPass<double>& pass) { doubles<NeoHookean>(pass); }
void neo_hookean_floats(const LocalPass<float>& pass) { floats<NeoHookean>(pass); }
void log_neo_hookean_doubles(const LocalPass<double>& pass) { doubles<LogNeoHookean>(pass); }
void log_neo_hookean_floats(const LocalPass<float>& pass) { floats<LogNeoHookean>(pass); }

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {

MESHORDER_EXPORT_LOCAL_PASS(strain)
MESHORDER_EXPORT_LOCAL_PASS(stvk)
MESHORDER_EXPORT_LOCAL_PASS(neo_hookean)
MESHORDER_EXPORT_LOCAL_PASS(log_neo_hookean)

}  // namespace meshorder
#endif
