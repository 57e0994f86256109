// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_COROTATIONAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_COROTATIONAL_INL
#undef MESHORDER_COROTATIONAL_INL
#else
#define MESHORDER_COROTATIONAL_INL
#endif

#include "kernels/deformation-inl.hpp"
#include "kernels/matrix-inl.hpp"
#include "kernels/projected-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Lower bound for the sum of two singular values in a tangent: the Hessian is infinite if a sum is 0. Only
/// nearly collapsed elements have smaller sums.
inline constexpr double kMinSum = 1e-6;

/// Corotational linear elasticity: P = 2μ (F − R) + λ tr(RᵀF − I) R.
template <class Lanes>
struct Corotational {
  using Value = typename Lanes::Value;
  Value r[3][3];      ///< the rotation closest to F
  Value trace;        ///< tr S = R:F
  Value coefficient;  ///< c in P = 2μF + cR: c = λ (tr S − 3) − 2μ

  HWY_INLINE void load(const Deformation<3, Lanes>& deformation, const LameLanes<Lanes>& lame) {
    closest_rotations<Lanes>(deformation.f, r);
    trace = contract<Lanes>(deformation.f, r);
    coefficient = Lanes::mul_add(lame.lambda, trace - Lanes::set(3.0), Lanes::set(-2.0) * lame.mu);
  }

  HWY_INLINE void stress(const Deformation<3, Lanes>& deformation, const LameLanes<Lanes>& lame,
                         Value (&p)[3][3]) const {
    // not computed as 2μF + cR, whose terms cancel near rest
    const Value two_mu = lame.mu + lame.mu;
    const Value pressure = lame.lambda * (trace - Lanes::set(3.0));
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = 0; j < 3; ++j) {
        p[i][j] = Lanes::mul_add(two_mu, deformation.f[i][j] - r[i][j], pressure * r[i][j]);
      }
    }
  }

  /// Returns the energy density μ ‖F − R‖² + ½ λ tr²(RᵀF − I).
  [[nodiscard]] HWY_INLINE Value energy(const Deformation<3, Lanes>& deformation,
                                        const LameLanes<Lanes>& lame) const {
    Value squares = Lanes::set(0.0);
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = 0; j < 3; ++j) {
        const Value difference = deformation.f[i][j] - r[i][j];
        squares = Lanes::mul_add(difference, difference, squares);
      }
    }
    const Value stretch = trace - Lanes::set(3.0);
    return Lanes::mul_add(lame.mu, squares, Lanes::set(0.5) * lame.lambda * (stretch * stretch));
  }

  /// Sets the Hessian in principal stretches; the energy's derivatives are ψᵢ = 2μ σᵢ + c.
  HWY_INLINE void principal(const Value (&sigma)[3], const LameLanes<Lanes>& lame,
                            PrincipalHessian<Lanes>& hessian) const {
    const Value two_mu = lame.mu + lame.mu;
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      const Value sum = Lanes::max(sigma[(k + 1) % 3] + sigma[(k + 2) % 3], Lanes::set(kMinSum));
      hessian.twist[k] = two_mu + (coefficient + coefficient) / sum;
      hessian.flip[k] = two_mu;
      MESHORDER_UNROLL
      for (int j = k; j < 3; ++j) {
        hessian.stretch[k][j] = j == k ? two_mu + lame.lambda : lame.lambda;
      }
    }
  }
};

/// The tangent with R held constant: the rotated stiffness of linear elasticity. With p_a = R g_a,
/// K_ab = V (λ p_a p_bᵀ + μ p_b p_aᵀ + μ (g_a·g_b) I).
template <class Lanes>
struct TurnedTangent {
  using Value = typename Lanes::Value;
  Value p[3][3];
  Value lambda_p[3][3];
  Value mu_p[3][3];
  Value material[3][3];

  HWY_INLINE void load(const Deformation<3, Lanes>& deformation, const Corotational<Lanes>& law,
                       const LameLanes<Lanes>& lame, Value weight) {
    const Value mu = lame.mu * weight;
    const Value lambda = lame.lambda * weight;
    MESHORDER_UNROLL
    for (int a = 0; a < 3; ++a) {
      deformation.times_gradient(law.r, a, p[a]);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) {
        lambda_p[a][c] = lambda * p[a][c];
        mu_p[a][c] = mu * p[a][c];
      }
      MESHORDER_UNROLL
      for (int b = a; b < 3; ++b) material[a][b] = mu * deformation.gradients(a, b);
    }
  }

  HWY_INLINE void block(int a, int b, Value (&k)[9]) const {
    fill_block(a == b, k, [&](int i, int j) MESHORDER_INLINE_LAMBDA {
      const Value sum = Lanes::mul_add(lambda_p[a][i], p[b][j], mu_p[b][i] * p[a][j]);
      return i == j ? sum + material[a][b] : sum;
    });
  }
};

/// The exact tangent (Barbič 2012). P = 2μF + cR varies by 2μ δF + λ (R:δF) R + c δR. R varies by δR = [ω]×
/// R, where (tr(S) I − F Rᵀ) ω is the axial vector of δF Rᵀ − R δFᵀ. For δF = δx g_bᵀ that vector is p_b × δx
/// with p_b = R g_b. So K_ab = V (2μ (g_a·g_b) I + λ p_a p_bᵀ + c [p_a]×ᵀ (tr(S) I − F Rᵀ)⁻¹ [p_b]×).
template <class Lanes>
struct CorotationalTangent {
  using Value = typename Lanes::Value;
  Value p[3][3];
  Value lambda_p[3][3];
  Value material[3][3];
  Value turn[3][3];  ///< V c (tr(S) I − F Rᵀ)⁻¹

  HWY_INLINE void load(const Deformation<3, Lanes>& deformation, const Corotational<Lanes>& law,
                       const LameLanes<Lanes>& lame, Value weight) {
    const Value two_mu = (lame.mu + lame.mu) * weight;
    const Value lambda = lame.lambda * weight;
    MESHORDER_UNROLL
    for (int a = 0; a < 3; ++a) {
      deformation.times_gradient(law.r, a, p[a]);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) lambda_p[a][c] = lambda * p[a][c];
      MESHORDER_UNROLL
      for (int b = a; b < 3; ++b) material[a][b] = two_mu * deformation.gradients(a, b);
    }
    load_turn(deformation, law, weight * law.coefficient);
  }

  HWY_INLINE void block(int a, int b, Value (&k)[9]) const {
    // T [p_b]×, whose row i is (row i of T) × p_b; then [p_a]×ᵀ times this matrix
    Value turned[3][3];
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = 0; j < 3; ++j) {
        const int next = (j + 1) % 3;
        const int last = (j + 2) % 3;
        turned[i][j] = turn[i][next] * p[b][last] - turn[i][last] * p[b][next];
      }
    }
    fill_block(a == b, k, [&](int i, int j) MESHORDER_INLINE_LAMBDA {
      const int next = (i + 1) % 3;
      const int last = (i + 2) % 3;
      const Value of_turn = p[a][last] * turned[next][j] - p[a][next] * turned[last][j];
      const Value sum = Lanes::mul_add(lambda_p[a][i], p[b][j], of_turn);
      return i == j ? sum + material[a][b] : sum;
    });
  }

 private:
  HWY_INLINE void load_turn(const Deformation<3, Lanes>& deformation, const Corotational<Lanes>& law,
                            Value weight) {
    // G = tr(S) I − F Rᵀ has the eigenvalues σᵢ + σⱼ, which are not negative
    Value g[3][3];
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < 3; ++j) {
        Value sum = deformation.f[i][0] * law.r[j][0];
        sum = Lanes::mul_add(deformation.f[i][1], law.r[j][1], sum);
        sum = Lanes::mul_add(deformation.f[i][2], law.r[j][2], sum);
        g[i][j] = g[j][i] = i == j ? law.trace - sum : Lanes::set(0.0) - sum;
      }
    }
    cofactors<Lanes>(g, turn);
    Value determinant = g[0][0] * turn[0][0];
    determinant = Lanes::mul_add(g[0][1], turn[0][1], determinant);
    determinant = Lanes::mul_add(g[0][2], turn[0][2], determinant);
    // keeps the least eigenvalue above about kMinSum: the product of the two larger eigenvalues is about
    // tr²(S)
    const Value min_determinant =
        Lanes::mul_add(Lanes::set(kMinSum) * law.trace, law.trace, Lanes::set(1e-280));
    const Value factor = weight / Lanes::max(determinant, min_determinant);
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < 3; ++j) turn[i][j] = turn[j][i] = factor * turn[i][j];
    }
  }
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
