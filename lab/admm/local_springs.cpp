// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/local_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/admm/local_springs.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/float_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

template <class Lanes>
HWY_INLINE typename Lanes::Value squared_length(const typename Lanes::Value (&q)[3]) {
  return Lanes::mul_add(q[2], q[2], Lanes::mul_add(q[1], q[1], q[0] * q[0]));
}

/// Computes unit vectors along any q, even if the square of q overflows or underflows. For q = 0, takes the
/// direction of the rest edge.
template <class Lanes>
HWY_NOINLINE void find_directions(const typename Lanes::Value (&q)[3],
                                  const typename Lanes::Number* rest_direction,
                                  typename Lanes::Value (&direction)[3]) {
  using Value = typename Lanes::Value;
  const Value largest = Lanes::max(Lanes::max(Lanes::abs(q[0]), Lanes::abs(q[1])), Lanes::abs(q[2]));
  MESHORDER_UNROLL
  for (int c = 0; c < 3; ++c) {
    // where `largest` is not positive, q is 0 or NaN; adding q keeps a NaN
    direction[c] =
        Lanes::choose(largest, q[c] / largest,
                      Lanes::load(rest_direction + c * kLocalBatch<typename Lanes::Number>) + q[c]);
  }
  const Value length = Lanes::square_root(squared_length<Lanes>(direction));
  MESHORDER_UNROLL
  for (Value& coordinate : direction) coordinate = coordinate / length;
}

/// Takes the steps z = ½(q + ℓ₀ q/‖q‖), so that 2z − q = ℓ₀ q/‖q‖.
template <class Lanes>
HWY_INLINE void pass_any(const LocalPass<typename Lanes::Number>& pass) {
  using Number = typename Lanes::Number;
  using Value = typename Lanes::Value;
  constexpr Index kBatchOf = kLocalBatch<Number>;
  // squares between these bounds have full precision
  constexpr double kMin = std::is_same_v<Number, float> ? 1e-30 : 1e-280;
  constexpr double kMax = 1.0 / kMin;
  const Value half = Lanes::set(0.5);
  const Value factor = Lanes::set(pass.scale * pass.stiffness);
  const auto count = static_cast<Offset>(pass.share.batches.size());
  for (Offset i = 0; i < count; ++i) {
    const Offset batch = pass.share.batches[i];
    const Index* const ends = pass.vertices + 2 * kBatchOf * batch;
    const Index* const targets = pass.share.targets_of(i, ends, 2 * (kBatchOf / kBatch));
    Number* const duals = pass.duals + 3 * kBatchOf * i;
    Value primal = Lanes::set(0.0);
    Value magnitude = Lanes::set(0.0);
    for (Index lane = 0; lane < kBatchOf; lane += Lanes::kCount) {
      Value q[3];
      Value b[3];
      Lanes::gather(pass.positions, ends + lane, q);
      Lanes::gather(pass.positions, ends + kBatchOf + lane, b);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) q[c] = q[c] - b[c] + Lanes::load(duals + c * kBatchOf + lane);
      Value direction[3];
      const Value square = squared_length<Lanes>(q);
      if (Lanes::all_at_most(square, kMax) && Lanes::all_at_most(Lanes::set(kMin) - square, 0.0)) {
        const Value inverse = Lanes::set(1.0) / Lanes::square_root(square);
        MESHORDER_UNROLL
        for (int c = 0; c < 3; ++c) direction[c] = inverse * q[c];
      } else {
        find_directions<Lanes>(q, pass.directions + 3 * kBatchOf * batch + lane, direction);
      }
      const Value rest_length = Lanes::load(pass.rest + kBatchOf * batch + lane);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) {
        const Value reflected = rest_length * direction[c];
        const Value z = half * (q[c] + reflected);
        const Value dual = q[c] - z;
        const Value change = dual - Lanes::load(duals + c * kBatchOf + lane);
        Lanes::store(dual, duals + c * kBatchOf + lane);
        primal = Lanes::mul_add(change, change, primal);
        magnitude = Lanes::mul_add(z, z, magnitude);
        q[c] = factor * reflected;
        b[c] = Lanes::set(0.0) - q[c];
      }
      Lanes::scatter_add(q, targets + lane, pass.right_hand_side);
      Lanes::scatter_add(b, targets + kBatchOf + lane, pass.right_hand_side);
    }
    const auto stiffness = static_cast<double>(pass.stiffness);
    pass.residuals[2 * i] = stiffness * static_cast<double>(Lanes::sum(primal));
    pass.residuals[2 * i + 1] = stiffness * static_cast<double>(Lanes::sum(magnitude));
  }
}

void springs_doubles(const LocalPass<double>& pass) { pass_any<ManyLanes>(pass); }
void springs_floats(const LocalPass<float>& pass) { pass_any<ManyFloatLanes>(pass); }

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {

MESHORDER_EXPORT_LOCAL_PASS(springs)

}  // namespace meshorder
#endif
