// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_ROTATION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_ROTATION_INL
#undef MESHORDER_ROTATION_INL
#else
#define MESHORDER_ROTATION_INL
#endif

#include "kernels/eigen-inl.hpp"
#include "kernels/matrix-inl.hpp"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Computes the rotations closest to arbitrary matrices. Such a rotation's unit quaternion q maximises qᵀN q,
/// where N is a symmetric 4×4 matrix linear in F (Davenport; Horn 1987). So q is an eigenvector of the
/// largest eigenvalue of N.
template <class Lanes>
HWY_NOINLINE void rotations_by_quaternions(const typename Lanes::Value (&f)[3][3],
                                           typename Lanes::Value (&r)[3][3]) {
  using Value = typename Lanes::Value;
  constexpr double kSmallest = std::is_same_v<typename Lanes::Number, float> ? 1e-36 : 1e-290;
  const Value zero = Lanes::set(0.0);
  const Value one = Lanes::set(1.0);
  // scale entries to at most 1 in size, so that squares do not overflow; R does not depend on the scale
  Value largest = Lanes::abs(f[0][0]);
  Value not_finite = zero * f[0][0];  // NaN where an entry is infinite or NaN, else 0
  MESHORDER_UNROLL
  for (int k = 1; k < 9; ++k) {
    largest = Lanes::max(largest, Lanes::abs(f[k / 3][k % 3]));
    not_finite = not_finite + zero * f[k / 3][k % 3];
  }
  const Value scale = one / Lanes::max(largest, Lanes::set(kSmallest));
  Value m[3][3];
  MESHORDER_UNROLL
  for (int k = 0; k < 9; ++k) m[k / 3][k % 3] = scale * f[k / 3][k % 3];

  Value n[4][4];
  n[0][0] = m[0][0] + m[1][1] + m[2][2];
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    n[0][i + 1] = m[k][j] - m[j][k];
    n[i + 1][i + 1] = m[i][i] - m[j][j] - m[k][k];
  }
  n[1][2] = m[0][1] + m[1][0];
  n[1][3] = m[0][2] + m[2][0];
  n[2][3] = m[1][2] + m[2][1];
  Value values[4];
  Value vectors[4][4];
  symmetric_eigen<4, Lanes>(n, values, vectors);
  // of several equal largest eigenvalues, take the first: this gives the identity for F = 0
  Value greatest = values[0];
  Value q[4] = {vectors[0][0], vectors[1][0], vectors[2][0], vectors[3][0]};
  MESHORDER_UNROLL
  for (int v = 1; v < 4; ++v) {
    const Value above = values[v] - greatest;
    greatest = Lanes::choose(above, values[v], greatest);
    MESHORDER_UNROLL
    for (int k = 0; k < 4; ++k) q[k] = Lanes::choose(above, vectors[k][v], q[k]);
  }

  // q may not have length 1, so use 2 / ‖q‖² in place of 2
  Value norm = q[0] * q[0];
  MESHORDER_UNROLL
  for (int k = 1; k < 4; ++k) norm = Lanes::mul_add(q[k], q[k], norm);
  const Value two = Lanes::set(2.0) / norm;
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const Value squares = Lanes::mul_add(q[j + 1], q[j + 1], q[k + 1] * q[k + 1]);
    r[i][i] = one - two * squares + not_finite;
    const Value outer = q[i + 1] * q[j + 1];
    r[i][j] = two * (outer - q[0] * q[k + 1]) + not_finite;
    r[j][i] = two * Lanes::mul_add(q[0], q[k + 1], outer) + not_finite;
  }
}

/// Intermediate results of rotations_by_formula.
template <class Lanes>
struct RotationTerms {
  typename Lanes::Value cof[3][3];    ///< cof F
  typename Lanes::Value squares;      ///< ‖F‖²
  typename Lanes::Value determinant;  ///< det F
  typename Lanes::Value trace;        ///< tr RᵀF: the sum of the signed singular values
};

/// Computes the closest rotations by a formula. Returns false, with unusable results, unless every matrix has
/// a closest rotation that is well separated from others.
///
/// The largest eigenvalue of N is λ = tr S, the largest root of λ⁴ − 2aλ² − 8dλ + a² − 4b with a = ‖F‖²,
/// b = ‖cof F‖² and d = det F. Halley's method decreases to λ from √3 ‖F‖ without overshooting, since all
/// roots are real. R = ∂λ/∂F then follows by differentiating the polynomial:
/// R = ((λ² + a) F + 2λ cof F − 2 F FᵀF) / (λ³ − aλ − 2d), whose denominator is 2 Π (σᵢ + σⱼ), i < j.
template <class Lanes>
HWY_INLINE bool rotations_by_formula(const typename Lanes::Value (&f)[3][3], typename Lanes::Value (&r)[3][3],
                                     RotationTerms<Lanes>& terms) {
  using Value = typename Lanes::Value;
  constexpr bool kFloat = std::is_same_v<typename Lanes::Number, float>;
  constexpr int kSteps = 10;
  // convergence is cubic: if the relative error is this small before a step, only rounding errors remain
  // after that step
  constexpr double kNear = kFloat ? 1e-3 : 1e-6;
  // limit on the ratio λ³ / denominator, which is 27/16 at rest; rounding errors grow about as the square of
  // the ratio
  constexpr double kLargestRatio = kFloat ? 6.0 : 12.0;
  // least accepted root: its seventh power does not underflow
  constexpr double kSmallest = kFloat ? 1e-4 : 1e-40;
  const auto& cof = terms.cof;
  cofactors<Lanes>(f, terms.cof);
  const Value a = contract<Lanes>(f, f);
  const Value b = contract<Lanes>(cof, cof);
  Value d = f[0][0] * cof[0][0];
  d = Lanes::mul_add(f[0][1], cof[0][1], d);
  d = Lanes::mul_add(f[0][2], cof[0][2], d);
  const Value zero = Lanes::set(0.0);
  const Value two_a = a + a;
  const Value two_d = d + d;
  const Value constant = Lanes::mul_add(a, a, Lanes::set(-4.0) * b);
  const Value minus_eight_d = Lanes::set(-4.0) * two_d;
  Value root = Lanes::square_root(Lanes::set(3.0) * a);
  for (int step = 0;; ++step) {
    // value of the polynomial, a quarter of its first derivative, an eighth of its second
    const Value square = root * root;
    const Value value = Lanes::mul_add(square - two_a, square, Lanes::mul_add(minus_eight_d, root, constant));
    const Value slope = Lanes::mul_add(root, square - a, zero - two_d);
    const Value bend = Lanes::mul_add(Lanes::set(1.5), square, Lanes::set(-0.5) * a);
    const Value change = value * slope / (Lanes::set(4.0) * slope * slope - value * bend);
    root = root - change;
    if (Lanes::all_at_most(Lanes::abs(change) - Lanes::set(kNear) * root, 0.0)) break;
    if (step == kSteps) return false;
  }
  terms.squares = a;
  terms.determinant = d;
  terms.trace = root;
  const Value square = root * root;
  const Value denominator = Lanes::mul_add(root, square - a, zero - two_d);
  if (!Lanes::all_at_most(root * square - Lanes::set(kLargestRatio) * denominator, 0.0) ||
      !Lanes::all_at_most(Lanes::set(kSmallest) - root, 0.0)) {
    return false;
  }
  const Value inverse = Lanes::set(1.0) / denominator;
  const Value of_f = inverse * (square + a);
  const Value of_cofactors = inverse * (root + root);
  const Value of_cubes = zero - (inverse + inverse);
  Value ftf[3][3];
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    MESHORDER_UNROLL
    for (int j = i; j < 3; ++j) {
      Value sum = f[0][i] * f[0][j];
      sum = Lanes::mul_add(f[1][i], f[1][j], sum);
      ftf[i][j] = ftf[j][i] = of_cubes * Lanes::mul_add(f[2][i], f[2][j], sum);
    }
    ftf[i][i] = ftf[i][i] + of_f;
  }
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    MESHORDER_UNROLL
    for (int j = 0; j < 3; ++j) {
      Value sum = of_cofactors * cof[i][j];
      sum = Lanes::mul_add(f[i][0], ftf[0][j], sum);
      sum = Lanes::mul_add(f[i][1], ftf[1][j], sum);
      r[i][j] = Lanes::mul_add(f[i][2], ftf[2][j], sum);
    }
  }
  return true;
}

/// Computes the rotation closest to each 3×3 matrix F: R with RᵀR = I and det R = 1 that minimises ‖F − R‖.
/// For det F > 0 it is the rotation of F's polar decomposition. A closest rotation exists for every F. If
/// there are several (F = 0, or σ₂ + σ₃ = 0 for the signed singular values), returns one of them: the
/// identity for F = 0. NaN if an entry is not finite. The error is about 1e-15 σ₁ / (σ₂ + σ₃).
template <class Lanes>
HWY_INLINE void closest_rotations(const typename Lanes::Value (&f)[3][3], typename Lanes::Value (&r)[3][3]) {
  RotationTerms<Lanes> terms;
  if (rotations_by_formula<Lanes>(f, r, terms)) return;
  // copies, so that the compiler can keep the kernel's f and r in registers
  typename Lanes::Value from[3][3];
  typename Lanes::Value to[3][3];
  MESHORDER_UNROLL
  for (int k = 0; k < 9; ++k) from[k / 3][k % 3] = f[k / 3][k % 3];
  rotations_by_quaternions<Lanes>(from, to);
  MESHORDER_UNROLL
  for (int k = 0; k < 9; ++k) r[k / 3][k % 3] = to[k / 3][k % 3];
}

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
