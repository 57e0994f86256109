// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_SINGULAR_VALUES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_SINGULAR_VALUES_INL
#undef MESHORDER_SINGULAR_VALUES_INL
#else
#define MESHORDER_SINGULAR_VALUES_INL
#endif

#include "kernels/rotation-inl.hpp"
#include "lab/admm/hyperelastic_laws-inl.hpp"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Upper bound of singular values, so that no energy overflows.
inline constexpr double kLargestStretch = 1e4;

/// Solves h x = −g for the symmetric matrix h = L D Lᵀ, reading its upper triangle. Each pivot in D is
/// replaced by its magnitude, or by kMinPivot if that is larger, so that x is a descent direction.
template <class Lanes>
HWY_INLINE void descent_direction(const typename Lanes::Value (&h)[3][3], const typename Lanes::Value (&g)[3],
                                  typename Lanes::Value (&x)[3]) {
  using Value = typename Lanes::Value;
  constexpr double kMinPivot = 1e-2;
  const Value one = Lanes::set(1.0);
  const Value min_pivot = Lanes::set(kMinPivot);
  const Value d0 = one / Lanes::max(Lanes::abs(h[0][0]), min_pivot);
  const Value l10 = h[0][1] * d0;
  const Value l20 = h[0][2] * d0;
  const Value d1 = one / Lanes::max(Lanes::abs(h[1][1] - l10 * h[0][1]), min_pivot);
  const Value h12 = h[1][2] - l10 * h[0][2];
  const Value l21 = h12 * d1;
  const Value d2 = one / Lanes::max(Lanes::abs(h[2][2] - l20 * h[0][2] - l21 * h12), min_pivot);
  const Value y0 = Lanes::set(0.0) - g[0];
  const Value y1 = Lanes::set(0.0) - g[1] - l10 * y0;
  const Value y2 = Lanes::set(0.0) - g[2] - l20 * y0 - l21 * y1;
  x[2] = y2 * d2;
  x[1] = y1 * d1 - l21 * x[2];
  x[0] = y0 * d0 - l10 * x[1] - l20 * x[2];
}

/// Returns the law's energy plus ½‖z − σ‖².
template <class Lanes, class Law>
HWY_INLINE typename Lanes::Value objective(const Law& law, const typename Lanes::Value (&sigma)[3],
                                           const typename Lanes::Value (&z)[3]) {
  using Value = typename Lanes::Value;
  Value squares = Lanes::set(0.0);
  MESHORDER_UNROLL
  for (int k = 0; k < 3; ++k) {
    const Value difference = z[k] - sigma[k];
    squares = Lanes::mul_add(difference, difference, squares);
  }
  return Lanes::mul_add(Lanes::set(0.5), squares, law.energy(z));
}

/// For each pair of indices i, j, puts zᵢ and zⱼ in the order of σᵢ and σⱼ, and gives zᵢ + zⱼ the sign of
/// σᵢ + σⱼ. The energy stays the same and z comes closer to σ, so that minima among singular values become
/// minima among all matrices. Returns whether any lane changed.
template <class Lanes>
HWY_INLINE bool match_order(const typename Lanes::Value (&sigma)[3], typename Lanes::Value (&z)[3]) {
  using Value = typename Lanes::Value;
  const Value zero = Lanes::set(0.0);
  Value changed = zero;
  MESHORDER_UNROLL
  for (int k = 0; k < 3; ++k) {
    const int i = k;
    const int j = (k + 1) % 3;
    const Value turned = zero - (sigma[i] - sigma[j]) * (z[i] - z[j]);
    const Value low = z[i];
    z[i] = Lanes::choose(turned, z[j], z[i]);
    z[j] = Lanes::choose(turned, low, z[j]);
    const Value flipped = zero - (sigma[i] + sigma[j]) * (z[i] + z[j]);
    const Value old = z[i];
    z[i] = Lanes::choose(flipped, zero - z[j], z[i]);
    z[j] = Lanes::choose(flipped, zero - old, z[j]);
    changed = Lanes::max(changed, Lanes::max(turned, flipped));
  }
  return !Lanes::all_at_most(changed, 0.0);
}

/// Finds a local minimum of the objective by Newton's method with backtracking, until no lane moves. Starts
/// from σ (raised to positive values where the law needs them) or from the step of Hooke's law, whichever has
/// the lower objective. The result is finite if σ is.
template <class Lanes, class Law>
HWY_NOINLINE void minimise(const Law& law, const typename Lanes::Value (&sigma)[3],
                           typename Lanes::Value (&z)[3]) {
  using Value = typename Lanes::Value;
  using Number = typename Lanes::Number;
  constexpr int kSteps = 100;
  constexpr int kHalvings = 40;
  constexpr double kArmijo = 1e-4;
  constexpr double kRounding = 8 * static_cast<double>(std::numeric_limits<Number>::epsilon());
  // the error after a step of this size is about its square
  constexpr double kNear = std::is_same_v<Number, float> ? 1e-4 : 1e-9;
  constexpr double kMinStart = 0.2;
  const Value zero = Lanes::set(0.0);
  const Value one = Lanes::set(1.0);
  Value s;
  Value c;
  hookean_step<Lanes>(law.m, sigma[0] + sigma[1] + sigma[2], s, c);
  Value other[3];
  MESHORDER_UNROLL
  for (int k = 0; k < 3; ++k) {
    z[k] = Law::kBarrier ? Lanes::max(sigma[k], Lanes::set(kMinStart)) : sigma[k];
    other[k] = Lanes::mul_add(s, sigma[k], c);
  }
  Value here = objective<Lanes>(law, sigma, z);
  const Value of_other = objective<Lanes>(law, sigma, other);
  MESHORDER_UNROLL
  for (int k = 0; k < 3; ++k) z[k] = Lanes::choose(here - of_other, other[k], z[k]);
  here = Lanes::min(here, of_other);
  for (int step = 0; step < kSteps; ++step) {
    if (match_order<Lanes>(sigma, z)) here = objective<Lanes>(law, sigma, z);
    Value gradient[3];
    Value hessian[3][3];
    law.derivatives(z, gradient, hessian);
    Value largest = zero;
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      gradient[k] = gradient[k] + (z[k] - sigma[k]);
      hessian[k][k] = hessian[k][k] + one;
      largest = Lanes::max(largest, Lanes::abs(z[k]));
    }
    Value direction[3];
    descent_direction<Lanes>(hessian, gradient, direction);
    Value slope = zero;
    Value longest = zero;
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      slope = Lanes::mul_add(gradient[k], direction[k], slope);
      longest = Lanes::max(longest, Lanes::abs(direction[k]));
    }
    // a lane's step is halved until the objective decreases, up to rounding
    const Value slack = Lanes::set(kRounding) * (one + Lanes::abs(here));
    Value length = one;
    Value next[3];
    Value after = here;
    for (int halving = 0;; ++halving) {
      MESHORDER_UNROLL
      for (int k = 0; k < 3; ++k) next[k] = Lanes::mul_add(length, direction[k], z[k]);
      after = objective<Lanes>(law, sigma, next);
      // not positive where the objective is NaN
      const Value below = Lanes::mul_add(Lanes::set(kArmijo) * length, slope, here + slack) - after;
      const Value taken = Lanes::choose(below, one, zero);
      if (halving == kHalvings || Lanes::all_at_most(one - taken, 0.0)) {
        MESHORDER_UNROLL
        for (int k = 0; k < 3; ++k) z[k] = Lanes::choose(taken, next[k], z[k]);
        here = Lanes::choose(taken, after, here);
        longest = Lanes::if_positive(taken, longest);
        break;
      }
      length = Lanes::choose(taken, length, Lanes::set(0.5) * length);
    }
    // a lane of NaN does not move
    const Value moves = longest - Lanes::set(kNear) * (one + largest);
    if (Lanes::all_at_most(Lanes::choose(moves, one, zero), 0.0)) break;
  }
}

/// Computes z = U diag(z₁, z₂, z₃) Vᵀ for any q = U diag(σ) Vᵀ. V are the eigenvectors of Rᵀq, with R the
/// rotation closest to q, and U = R V.
template <class Lanes, class Law>
HWY_NOINLINE void step_by_singular_values(const Law& law, const typename Lanes::Value (&q)[3][3],
                                          typename Lanes::Value (&z)[3][3]) {
  using Value = typename Lanes::Value;
  constexpr double kSmallest = std::is_same_v<typename Lanes::Number, float> ? 1e-36 : 1e-290;
  // scaled to entries of at most 1, so that no square overflows
  Value largest = Lanes::set(kSmallest);
  MESHORDER_UNROLL
  for (int k = 0; k < 9; ++k) largest = Lanes::max(largest, Lanes::abs(q[k / 3][k % 3]));
  const Value inverse = Lanes::set(1.0) / largest;
  Value scaled[3][3];
  MESHORDER_UNROLL
  for (int k = 0; k < 9; ++k) scaled[k / 3][k % 3] = inverse * q[k / 3][k % 3];
  Value r[3][3];
  closest_rotations<Lanes>(scaled, r);
  Value s[3][3];
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    MESHORDER_UNROLL
    for (int j = i; j < 3; ++j) {
      Value sum = Lanes::set(0.0);
      MESHORDER_UNROLL
      for (int k = 0; k < 3; ++k) {
        sum = Lanes::mul_add(r[k][i], scaled[k][j], sum);
        sum = Lanes::mul_add(r[k][j], scaled[k][i], sum);
      }
      s[i][j] = Lanes::set(0.5) * sum;
    }
  }
  Value sigma[3];
  Value v[3][3];
  symmetric_eigen<3, Lanes>(s, sigma, v);
  const Value limit = Lanes::set(kLargestStretch);
  MESHORDER_UNROLL
  for (Value& stretch : sigma) {
    stretch = largest * stretch;
    stretch = Lanes::choose(Lanes::abs(stretch) - limit, Lanes::with_sign_of(limit, stretch), stretch);
  }
  Value values[3];
  minimise<Lanes>(law, sigma, values);
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    Value u[3];
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      u[k] = r[i][0] * v[0][k];
      u[k] = Lanes::mul_add(r[i][1], v[1][k], u[k]);
      u[k] = values[k] * Lanes::mul_add(r[i][2], v[2][k], u[k]);
    }
    MESHORDER_UNROLL
    for (int j = 0; j < 3; ++j) {
      z[i][j] = Lanes::mul_add(u[0], v[j][0], Lanes::mul_add(u[1], v[j][1], u[2] * v[j][2]));
    }
  }
}

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
