// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_HYPERELASTIC_LAWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_HYPERELASTIC_LAWS_INL
#undef MESHORDER_HYPERELASTIC_LAWS_INL
#else
#define MESHORDER_HYPERELASTIC_LAWS_INL
#endif

#include "kernels/matrix-inl.hpp"

#include <hwy/contrib/math/math-inl.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Returns log a to a few units in the last place; not finite unless a > 0.
template <class Lanes>
HWY_INLINE typename Lanes::Value logarithm(typename Lanes::Value a) {
  if constexpr (Lanes::kCount == 1)
    return std::log(a);
  else
    return Lanes::choose(a, hn::Log(typename Lanes::Tag(), a),
                         Lanes::set(std::numeric_limits<double>::quiet_NaN()));
}

/// The factors of F + P/κ = A F + b cof F + γ R. P is the stress of an isotropic law, κ the bulk modulus, and
/// R the rotation closest to F (see proximal-inl.hpp). A, b and γ (`shift`) are functions of p =
/// (σ₁ + σ₂ + σ₃, σ₁σ₂ + σ₁σ₃ + σ₂σ₃, σ₁σ₂σ₃). Each law sets the derivatives that it needs.
template <class Lanes>
struct StressFactors {
  typename Lanes::Value a, b, shift;
  typename Lanes::Value of_a[2];      ///< ∂A/∂p₁, ∂A/∂p₂
  typename Lanes::Value of_b;         ///< ∂b/∂p₃; for a law with a shift, ∂b/∂p₁
  typename Lanes::Value of_shift[3];  ///< ∂γ/∂p
};

/// Computes the step Z = s S + c I of Hooke's law, to which all laws reduce near rest. The step divides the
/// deviatoric part of S − I by 1 + 2m and the mean of S − I by 4.
template <class Lanes>
HWY_INLINE void hookean_step(typename Lanes::Value m, typename Lanes::Value trace, typename Lanes::Value& s,
                             typename Lanes::Value& c) {
  const typename Lanes::Value one = Lanes::set(1.0);
  s = one / (m + m + one);
  c = Lanes::mul_add(trace, Lanes::set(1.0 / 12.0) - Lanes::set(1.0 / 3.0) * s, Lanes::set(0.75));
}

/// Returns sum + Σ σᵢ².
template <class Lanes>
HWY_INLINE typename Lanes::Value plus_squares(typename Lanes::Value sum,
                                              const typename Lanes::Value (&sigma)[3]) {
  MESHORDER_UNROLL
  for (const auto& value : sigma) sum = Lanes::mul_add(value, value, sum);
  return sum;
}

// Energies, gradients and Hessians of a law are per volume, divided by the bulk modulus κ, and functions of
// the signed singular values σ. m = μ/κ, l = λ/κ = 1 − ⅔m.

/// MaterialModel::stvk, with the energy ¼m Σ (σᵢ² − 1)² + ⅛l (Σ σᵢ² − 3)².
template <class Lanes>
struct StvkSteps {
  using Value = typename Lanes::Value;
  static constexpr bool kShift = true;
  static constexpr bool kConstantFactor = false;
  static constexpr bool kBarrier = false;
  Value m, l;

  HWY_INLINE explicit StvkSteps(const typename Lanes::Number* softness)
      : m(Lanes::load(softness)), l(Lanes::mul_add(Lanes::set(-2.0 / 3.0), m, Lanes::set(1.0))) {}

  HWY_INLINE void factors(const Value (&p)[3], StressFactors<Lanes>& result) const {
    // F FᵀF = p₁ cof F + (p₁² − p₂) F + (p₃ − p₁p₂) R
    const Value square = p[0] * p[0];
    const Value norm = square - (p[1] + p[1]) - Lanes::set(3.0);
    result.a = Lanes::mul_add(Lanes::set(0.5) * l, norm,
                              Lanes::mul_add(m, square - p[1] - Lanes::set(1.0), Lanes::set(1.0)));
    result.b = m * p[0];
    result.shift = m * (p[2] - p[0] * p[1]);
    result.of_a[0] = (l + m + m) * p[0];
    result.of_a[1] = Lanes::set(0.0) - (l + m);
    result.of_b = m;
    result.of_shift[0] = Lanes::set(0.0) - m * p[1];
    result.of_shift[1] = Lanes::set(0.0) - m * p[0];
    result.of_shift[2] = m;
  }

  HWY_INLINE Value energy(const Value (&sigma)[3]) const {
    Value sum = Lanes::set(0.0);
    Value squares = Lanes::set(0.0);
    MESHORDER_UNROLL
    for (const Value& value : sigma) {
      const Value green = Lanes::mul_add(value, value, Lanes::set(-1.0));
      sum = sum + green;
      squares = Lanes::mul_add(green, green, squares);
    }
    return Lanes::mul_add(Lanes::set(0.25) * m, squares, Lanes::set(0.125) * l * sum * sum);
  }

  HWY_INLINE void derivatives(const Value (&sigma)[3], Value (&gradient)[3], Value (&hessian)[3][3]) const {
    const Value sum = plus_squares<Lanes>(Lanes::set(-3.0), sigma);
    const Value common = Lanes::set(0.5) * l * sum - m;
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      const Value square = sigma[k] * sigma[k];
      gradient[k] = Lanes::mul_add(m, square, common) * sigma[k];
      MESHORDER_UNROLL
      for (int j = k; j < 3; ++j) hessian[k][j] = l * sigma[k] * sigma[j];
      hessian[k][k] = hessian[k][k] + Lanes::mul_add(Lanes::set(3.0) * m, square, common);
    }
  }
};

/// MaterialModel::neo_hookean.
template <class Lanes>
struct NeoHookeanSteps {
  using Value = typename Lanes::Value;
  static constexpr bool kShift = false;
  static constexpr bool kConstantFactor = false;
  static constexpr bool kBarrier = false;
  Value m;       ///< ¾ μ'/κ
  Value mu;      ///< μ'/κ
  Value lambda;  ///< λ'/κ

  HWY_INLINE explicit NeoHookeanSteps(const typename Lanes::Number* softness)
      : m(Lanes::load(softness)),
        mu(Lanes::set(4.0 / 3.0) * m),
        lambda(Lanes::mul_add(Lanes::set(1.0 / 6.0), m, Lanes::set(1.0))) {}

  HWY_INLINE void factors(const Value (&p)[3], StressFactors<Lanes>& result) const {
    const Value one = Lanes::set(1.0);
    const Value inverse = one / (Lanes::mul_add(p[0], p[0], one) - (p[1] + p[1]));
    const Value part = mu * inverse;
    result.a = one + mu - part;
    result.of_a[1] = Lanes::set(-2.0) * part * inverse;
    result.of_a[0] = Lanes::set(0.0) - result.of_a[1] * p[0];
    result.b = Lanes::mul_add(lambda, p[2] - one, Lanes::set(0.0) - m);
    result.of_b = lambda;
  }

  HWY_INLINE Value energy(const Value (&sigma)[3]) const {
    const Value one = Lanes::set(1.0);
    const Value growth = sigma[0] * sigma[1] * sigma[2] - one;
    const Value norm = plus_squares<Lanes>(one, sigma);
    const Value of_volume = growth * Lanes::mul_add(lambda, growth, Lanes::set(-2.0) * m);
    const Value of_length = mu * (norm - Lanes::set(4.0) - logarithm<Lanes>(Lanes::set(0.25) * norm));
    return Lanes::set(0.5) * (of_volume + of_length);
  }

  HWY_INLINE void derivatives(const Value (&sigma)[3], Value (&gradient)[3], Value (&hessian)[3][3]) const {
    const Value one = Lanes::set(1.0);
    const Value norm = plus_squares<Lanes>(one, sigma);
    const Value inverse = one / norm;
    const Value a = mu - mu * inverse;
    const Value of_lengths = (mu + mu) * inverse * inverse;
    const Value b = Lanes::mul_add(lambda, sigma[0] * sigma[1] * sigma[2] - one, Lanes::set(0.0) - m);
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      const Value others = sigma[(k + 1) % 3] * sigma[(k + 2) % 3];
      gradient[k] = Lanes::mul_add(a, sigma[k], b * others);
      hessian[k][k] =
          Lanes::mul_add(lambda * others, others, Lanes::mul_add(of_lengths * sigma[k], sigma[k], a));
      MESHORDER_UNROLL
      for (int j = k + 1; j < 3; ++j) {
        const Value& third = sigma[3 - k - j];
        const Value both = sigma[k] * sigma[j];
        hessian[k][j] = Lanes::mul_add(lambda * third * third + of_lengths, both, b * third);
      }
    }
  }
};

/// LocalModel::log_neo_hookean, with the energy ½m (Σ σᵢ² − 3) − m log J + ½l log² J, J = σ₁σ₂σ₃. The energy
/// is infinite unless all σᵢ are positive.
template <class Lanes>
struct LogNeoHookeanSteps {
  using Value = typename Lanes::Value;
  static constexpr bool kShift = false;
  static constexpr bool kConstantFactor = true;
  static constexpr bool kBarrier = true;
  Value m, l;

  HWY_INLINE explicit LogNeoHookeanSteps(const typename Lanes::Number* softness)
      : m(Lanes::load(softness)), l(Lanes::mul_add(Lanes::set(-2.0 / 3.0), m, Lanes::set(1.0))) {}

  HWY_INLINE void factors(const Value (&p)[3], StressFactors<Lanes>& result) const {
    const Value one = Lanes::set(1.0);
    const Value inverse = one / p[2];
    result.a = one + m;
    result.b = Lanes::mul_add(l, logarithm<Lanes>(p[2]), Lanes::set(0.0) - m) * inverse;
    result.of_b = Lanes::mul_add(l, inverse, Lanes::set(0.0) - result.b) * inverse;
  }

  HWY_INLINE Value energy(const Value (&sigma)[3]) const {
    const Value minus_one = Lanes::set(-1.0);
    const Value squares = plus_squares<Lanes>(Lanes::set(-3.0), sigma);
    Value positive = Lanes::set(1.0);
    MESHORDER_UNROLL
    for (const Value& value : sigma) positive = Lanes::choose(value, positive, minus_one);
    const Value log =
        logarithm<Lanes>(Lanes::choose(positive, sigma[0] * sigma[1] * sigma[2], Lanes::set(1.0)));
    const Value sum = Lanes::mul_add(Lanes::set(0.5) * m, squares,
                                     log * Lanes::mul_add(Lanes::set(0.5) * l, log, Lanes::set(0.0) - m));
    return Lanes::choose(positive, sum, Lanes::set(std::numeric_limits<typename Lanes::Number>::infinity()));
  }

  HWY_INLINE void derivatives(const Value (&sigma)[3], Value (&gradient)[3], Value (&hessian)[3][3]) const {
    const Value c = Lanes::mul_add(l, logarithm<Lanes>(sigma[0] * sigma[1] * sigma[2]), Lanes::set(0.0) - m);
    Value inverse[3];
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) inverse[k] = Lanes::set(1.0) / sigma[k];
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      gradient[k] = Lanes::mul_add(m, sigma[k], c * inverse[k]);
      MESHORDER_UNROLL
      for (int j = k + 1; j < 3; ++j) hessian[k][j] = l * inverse[k] * inverse[j];
      hessian[k][k] = Lanes::mul_add((l - c) * inverse[k], inverse[k], m);
    }
  }
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
