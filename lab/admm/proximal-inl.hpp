// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_PROXIMAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_PROXIMAL_INL
#undef MESHORDER_PROXIMAL_INL
#else
#define MESHORDER_PROXIMAL_INL
#endif

#include "kernels/rotation-inl.hpp"
#include "lab/admm/hyperelastic_laws-inl.hpp"
#include "lab/admm/singular_values-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Newton's method for the invariants p of Z in R (A Z + b cof Z + γ I) = q = R S. The three elementary
/// symmetric functions f of S − γ I are polynomials of p, A and b. The method needs neither singular values
/// nor singular vectors, and is not singular where two singular values are equal. `solve` returns false,
/// without a usable result, unless all lanes converge to a strict minimum.
template <class Lanes, class Law>
struct InvariantSteps {
  using Value = typename Lanes::Value;
  Value p[3];
  Value e[3];  ///< the symmetric functions of S
  Value f[3];  ///< the symmetric functions of S − γ I
  StressFactors<Lanes> factors;

  HWY_INLINE bool solve(const Law& law) {
    constexpr bool kFloat = std::is_same_v<typename Lanes::Number, float>;
    constexpr int kSteps = 8;
    // after a step of this size, only rounding errors are left
    constexpr double kNear = kFloat ? 1e-3 : 1e-7;
    start(law);
    for (int step = 0;; ++step) {
      law.factors(p, factors);
      shift();
      Value change[3];
      const Value determinant = changes(change);
      Value largest = Lanes::set(0.0);
      MESHORDER_UNROLL
      for (int k = 0; k < 3; ++k) {
        p[k] = p[k] - change[k];
        largest = Lanes::max(largest, Lanes::abs(change[k]));
      }
      if (Lanes::all_at_most(largest, kNear)) {
        law.factors(p, factors);
        shift();
        return is_minimum(determinant);
      }
      if (step == kSteps) return false;
    }
  }

  /// Computes z = R Z. Z is a polynomial of S whose coefficients need no differences of singular values: Z =
  /// (A² + b²p₂)/Δ S' − b/Δ S'² + … I with Δ = Π (A − b zₖ), S' = S − γ I.
  HWY_INLINE void expand(const Value (&q)[3][3], const Value (&r)[3][3], const Value (&cof)[3][3],
                         Value (&z)[3][3]) const {
    const Value& a = factors.a;
    const Value& b = factors.b;
    const Value bb = b * b;
    const Value inverse = Lanes::set(1.0) / discriminant();
    const Value square = Lanes::set(0.0) - b * inverse;
    Value linear = Lanes::mul_add(a, a, bb * p[1]) * inverse;
    Value constant = square * (Lanes::mul_add(a * a, p[1], bb * p[0] * p[2]) - (a + a) * b * p[2]);
    if constexpr (Law::kShift) {
      // S'² = S² − 2γ S + γ² I
      const Value& shift = factors.shift;
      constant = Lanes::mul_add(shift, square * shift - linear, constant);
      linear = linear - (square + square) * shift;
    }
    // R S² = cof q + e₁ q − e₂ R
    linear = Lanes::mul_add(square, e[0], linear);
    constant = constant - square * e[1];
    MESHORDER_UNROLL
    for (int k = 0; k < 9; ++k) {
      const int i = k / 3;
      const int j = k % 3;
      z[i][j] = Lanes::mul_add(constant, r[i][j], Lanes::mul_add(linear, q[i][j], square * cof[i][j]));
    }
  }

 private:
  /// Sets p to the invariants of the step of Hooke's law.
  HWY_INLINE void start(const Law& law) {
    Value s;
    Value c;
    hookean_step<Lanes>(law.m, e[0], s, c);
    const Value se = s * e[0];
    const Value sse = s * s * e[1];
    p[0] = Lanes::mul_add(Lanes::set(3.0), c, se);
    p[1] = Lanes::mul_add(c, Lanes::mul_add(Lanes::set(3.0), c, se + se), sse);
    p[2] = Lanes::mul_add(c, Lanes::mul_add(c, c + se, sse), s * s * s * e[2]);
  }

  HWY_INLINE void shift() {
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) f[k] = e[k];
    if constexpr (Law::kShift) {
      const Value& g = factors.shift;
      f[0] = e[0] - Lanes::set(3.0) * g;
      f[1] = Lanes::mul_add(g, Lanes::mul_add(Lanes::set(3.0), g, Lanes::set(-2.0) * e[0]), e[1]);
      f[2] = Lanes::mul_add(g, Lanes::mul_add(g, e[0] - g, Lanes::set(0.0) - e[1]), e[2]);
    }
  }

  /// Computes Newton's step and returns the determinant of the equations' Jacobian.
  HWY_INLINE Value changes(Value (&change)[3]) const {
    const Value& a = factors.a;
    const Value& b = factors.b;
    const Value aa = a * a;
    const Value ab = a * b;
    const Value bb = b * b;
    const Value p12 = p[0] * p[1];
    const Value p13 = p[0] * p[2];
    const Value mixed = p12 - Lanes::set(3.0) * p[2];   // Σ zᵢ²zⱼ
    const Value squares = p[0] * p[0] - (p[1] + p[1]);  // Σ zᵢ²
    const Value products = p[1] * p[1] - (p13 + p13);   // Σ zᵢ²zⱼ²
    const Value residual[3] = {
        Lanes::mul_add(a, p[0], b * p[1]) - f[0],
        Lanes::mul_add(aa, p[1], Lanes::mul_add(ab, mixed, bb * p13)) - f[1],
        Lanes::mul_add(
            aa, a * p[2],
            Lanes::mul_add(ab, Lanes::mul_add(a, products, b * p[2] * squares), bb * b * p[2] * p[2])) -
            f[2]};
    const Value zero = Lanes::set(0.0);
    const Value bp3 = b * p[2];
    Value j[3][3] = {{a, b, zero},
                     {b * Lanes::mul_add(a, p[1], bp3), Lanes::mul_add(ab, p[0], aa),
                      b * Lanes::mul_add(b, p[0], Lanes::set(-3.0) * a)},
                     {(ab + ab) * Lanes::mul_add(bp3, p[0], zero) - (ab + ab) * a * p[2],
                      (ab + ab) * Lanes::mul_add(a, p[1], zero - bp3),
                      Lanes::mul_add(aa, a - (b + b) * p[0], bb * Lanes::mul_add(a, squares, bp3 + bp3))}};
    if constexpr (!Law::kConstantFactor) {
      const Value of_a[3] = {
          p[0], Lanes::mul_add(a + a, p[1], b * mixed),
          Lanes::mul_add(Lanes::set(3.0) * aa, p[2], Lanes::mul_add(ab + ab, products, b * bp3 * squares))};
      MESHORDER_UNROLL
      for (int k = 0; k < 3; ++k) {
        j[k][0] = Lanes::mul_add(of_a[k], factors.of_a[0], j[k][0]);
        j[k][1] = Lanes::mul_add(of_a[k], factors.of_a[1], j[k][1]);
      }
    }
    const Value of_b[3] = {
        p[1], Lanes::mul_add(a, mixed, (b + b) * p13),
        Lanes::mul_add(aa, products, Lanes::mul_add((ab + ab) * p[2], squares, Lanes::set(3.0) * bp3 * bp3))};
    const Value of_shift[3] = {Lanes::set(3.0), f[0] + f[0], f[1]};
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      if constexpr (Law::kShift) {
        j[k][0] = Lanes::mul_add(of_b[k], factors.of_b, j[k][0]);
        MESHORDER_UNROLL
        for (int i = 0; i < 3; ++i) j[k][i] = Lanes::mul_add(of_shift[k], factors.of_shift[i], j[k][i]);
      } else {
        j[k][2] = Lanes::mul_add(of_b[k], factors.of_b, j[k][2]);
      }
    }
    Value cof[3][3];
    cofactors<Lanes>(j, cof);
    const Value determinant =
        Lanes::mul_add(j[0][0], cof[0][0], Lanes::mul_add(j[0][1], cof[0][1], j[0][2] * cof[0][2]));
    const Value inverse = Lanes::set(1.0) / determinant;
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      change[i] = inverse * Lanes::mul_add(cof[0][i], residual[0],
                                           Lanes::mul_add(cof[1][i], residual[1], cof[2][i] * residual[2]));
    }
    return determinant;
  }

  /// Returns Π (A − b zₖ), the product of the curvatures along opposed rotations of two singular vectors.
  HWY_INLINE Value discriminant() const {
    const Value& a = factors.a;
    const Value& b = factors.b;
    return Lanes::mul_add(a * a, a - b * p[0], b * b * Lanes::mul_add(a, p[1], Lanes::set(0.0) - b * p[2]));
  }

  /// Returns whether the nine curvatures are well above 0, judged by their products and sums:
  /// - for opposed rotations of two singular vectors, A − b zₖ;
  /// - for common rotations, curvatures with the signs of zᵢ + zⱼ;
  /// - for the stretches, curvatures whose product has the sign of the determinant.
  [[nodiscard]] HWY_INLINE bool is_minimum(Value determinant) const {
    constexpr double kMin = 0.02;
    const Value& a = factors.a;
    const Value& b = factors.b;
    const Value limit = Lanes::set(kMin);
    const Value sum = Lanes::set(3.0) * a - b * p[0];
    const Value pairs = Lanes::mul_add(a, Lanes::set(3.0) * a - (b + b) * p[0], b * b * p[1]);
    Value smallest = Lanes::min(Lanes::min(Lanes::min(sum, pairs), discriminant()),
                                Lanes::min(determinant, Lanes::min(p[0], p[0] * p[1] - p[2])));
    // a law with a shift has finite energies, and further minima, for inverted elements
    if constexpr (Law::kShift) smallest = Lanes::min(smallest, Lanes::set(0.2) * p[2]);
    return Lanes::all_at_most(limit - smallest, 0.0);
  }
};

/// Computes z = argmin Ψ(z)/κ + ½‖z − q‖² for an isotropic law.
///
/// With z = R Z the condition is A Z + b cof Z + γ I = S = Rᵀq, where the left side is Z plus its stress over
/// κ. Near rest this equation is solved for the invariants of Z, elsewhere for the singular values of Z.
template <class Lanes, class Law>
HWY_INLINE void proximal_step(const Law& law, const typename Lanes::Value (&q)[3][3],
                              typename Lanes::Value (&z)[3][3]) {
  using Value = typename Lanes::Value;
  RotationTerms<Lanes> terms;
  if (Value r[3][3]; rotations_by_formula<Lanes>(q, r, terms)) {
    InvariantSteps<Lanes, Law> steps;
    steps.e[0] = terms.trace;
    steps.e[1] = Lanes::set(0.5) * Lanes::mul_add(terms.trace, terms.trace, Lanes::set(0.0) - terms.squares);
    steps.e[2] = terms.determinant;
    if (steps.solve(law)) {
      steps.expand(q, r, terms.cof, z);
      return;
    }
  }
  // copies, so that q and z can stay in registers in the rest of the kernel
  Value from[3][3];
  Value to[3][3];
  MESHORDER_UNROLL
  for (int k = 0; k < 9; ++k) from[k / 3][k % 3] = q[k / 3][k % 3];
  step_by_singular_values<Lanes>(law, from, to);
  MESHORDER_UNROLL
  for (int k = 0; k < 9; ++k) z[k / 3][k % 3] = to[k / 3][k % 3];
}

/// The Law of pass_tetrahedra for a hyperelastic model.
template <class Lanes, class Law>
struct ProximalStep {
  Law law;

  HWY_INLINE explicit ProximalStep(const typename Lanes::Number* softness) : law(softness) {}

  HWY_INLINE void step(const typename Lanes::Value (&q)[3][3], typename Lanes::Value (&z)[3][3]) const {
    proximal_step<Lanes>(law, q, z);
  }
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
