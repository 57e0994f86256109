// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_NEO_HOOKEAN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_NEO_HOOKEAN_INL
#undef MESHORDER_NEO_HOOKEAN_INL
#else
#define MESHORDER_NEO_HOOKEAN_INL
#endif

#include "kernels/deformation-inl.hpp"
#include "kernels/matrix-inl.hpp"
#include "kernels/projected-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Stable Neo-Hookean: Ψ = ψ(F) − ψ(I) with ψ = ½μ' (‖F‖² − 3) + ½λ' (det F − α)² − ½μ' log(‖F‖² + 1),
/// α = 1 + ¾ μ'/λ'. Without the logarithm a collapsed element would rest at F = 0.
/// Near rest, μ' = 4/3 μ and λ' = λ + 5/6 μ give Hooke's law with Lamé's μ and λ.
template <class Lanes>
struct NeoHookean {
  using Value = typename Lanes::Value;
  Value mu;              ///< μ'
  Value lambda;          ///< λ'
  Value cof[3][3];       ///< ∂ det F / ∂F
  Value norm;            ///< ‖F‖² + 1
  Value determinant;     ///< det F
  Value of_deformation;  ///< coefficient of F in P: μ' (1 − 1 / (‖F‖² + 1))
  Value of_cofactors;    ///< coefficient of cof F in P: λ' (det F − α)

  HWY_INLINE void load(const Deformation<3, Lanes>& deformation, const LameLanes<Lanes>& lame) {
    const Value one = Lanes::set(1.0);
    mu = Lanes::set(4.0 / 3.0) * lame.mu;
    lambda = Lanes::mul_add(Lanes::set(5.0 / 6.0), lame.mu, lame.lambda);
    cofactors<Lanes>(deformation.f, cof);
    norm = contract<Lanes>(deformation.f, deformation.f) + one;
    determinant = deformation.f[0][0] * cof[0][0];
    determinant = Lanes::mul_add(deformation.f[0][1], cof[0][1], determinant);
    determinant = Lanes::mul_add(deformation.f[0][2], cof[0][2], determinant);
    of_deformation = mu - mu / norm;
    of_cofactors = Lanes::mul_add(lambda, determinant - one, Lanes::set(-0.75) * mu);
  }

  HWY_INLINE void stress(const Deformation<3, Lanes>& deformation, const LameLanes<Lanes>& /*lame*/,
                         Value (&p)[3][3]) const {
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = 0; j < 3; ++j) {
        p[i][j] = Lanes::mul_add(of_deformation, deformation.f[i][j], of_cofactors * cof[i][j]);
      }
    }
  }

  [[nodiscard]] HWY_INLINE Value energy(const Deformation<3, Lanes>& /*deformation*/,
                                        const LameLanes<Lanes>& /*lame*/) const {
    // ½λ' ((J − α)² − (1 − α)²) = ½ (J − 1) (λ' (J − 1) − 3/2 μ')
    const Value one = Lanes::set(1.0);
    const Value growth = determinant - one;
    const Value of_volume = growth * Lanes::mul_add(lambda, growth, Lanes::set(-1.5) * mu);
    const Value of_length = mu * (norm - Lanes::set(4.0) - Lanes::log(Lanes::set(0.25) * norm));
    return Lanes::set(0.5) * (of_volume + of_length);
  }

  /// Sets the Hessian in principal stretches; the energy's derivatives are ψᵢ = μ' (1 − 1/n) σᵢ + c σⱼ σₖ.
  HWY_INLINE void principal(const Value (&sigma)[3], const LameLanes<Lanes>& /*lame*/,
                            PrincipalHessian<Lanes>& hessian) const {
    const Value of_lengths = (mu + mu) / (norm * norm);
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      const Value& a = sigma[(k + 1) % 3];
      const Value& b = sigma[(k + 2) % 3];
      const Value turn = of_cofactors * sigma[k];
      hessian.twist[k] = of_deformation + turn;
      hessian.flip[k] = of_deformation - turn;
      hessian.stretch[k][k] = Lanes::mul_add(lambda, (a * b) * (a * b),
                                             Lanes::mul_add(of_lengths, sigma[k] * sigma[k], of_deformation));
      MESHORDER_UNROLL
      for (int j = k + 1; j < 3; ++j) {
        // the cofactors of σ_k and σ_j both contain the third value
        const Value& third = sigma[3 - k - j];
        const Value both = sigma[k] * sigma[j];
        hessian.stretch[k][j] = Lanes::mul_add(lambda * third * third, both, of_lengths * both);
        hessian.stretch[k][j] = Lanes::mul_add(of_cofactors, third, hessian.stretch[k][j]);
      }
    }
  }
};

/// The exact tangent. With p_a = F g_a, q_a = cof(F) g_a and c the coefficient of cof F in P,
/// K_ab = V (μ' (1 − 1/n) (g_a·g_b) I + 2μ'/n² p_a p_bᵀ + λ' q_a q_bᵀ − c [F (g_a × g_b)]×), n = ‖F‖² + 1.
template <class Lanes>
struct NeoHookeanTangent {
  using Value = typename Lanes::Value;
  Value p[3][3];
  Value q[3][3];
  Value weighted_p[3][3];
  Value weighted_q[3][3];
  Value material[3][3];
  Value turn[3][3];  ///< V c F (g_a × g_b) for the corners 01, 02, 12

  HWY_INLINE void load(const Deformation<3, Lanes>& deformation, const NeoHookean<Lanes>& law,
                       const LameLanes<Lanes>& /*lame*/, Value weight) {
    const Value of_p = (weight + weight) * law.mu / (law.norm * law.norm);
    const Value of_q = weight * law.lambda;
    const Value of_identity = weight * law.of_deformation;
    MESHORDER_UNROLL
    for (int a = 0; a < 3; ++a) {
      deformation.times_gradient(deformation.f, a, p[a]);
      deformation.times_gradient(law.cof, a, q[a]);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) {
        weighted_p[a][c] = of_p * p[a][c];
        weighted_q[a][c] = of_q * q[a][c];
      }
      MESHORDER_UNROLL
      for (int b = a; b < 3; ++b) material[a][b] = of_identity * deformation.gradients(a, b);
    }
    // the gradients are the rows of an upper triangular matrix, so some components are 0
    const auto& g = deformation.g;
    const Value of_turn = weight * law.of_cofactors;
    const Value zero = Lanes::set(0.0);
    const Value crosses[3][3] = {
        {g[0][1] * g[1][2] - g[0][2] * g[1][1], zero - g[0][0] * g[1][2], g[0][0] * g[1][1]},
        {g[0][1] * g[2][2], zero - g[0][0] * g[2][2], zero},
        {g[1][1] * g[2][2], zero, zero}};
    MESHORDER_UNROLL
    for (int pair = 0; pair < 3; ++pair) {
      MESHORDER_UNROLL
      for (int i = 0; i < 3; ++i) {
        Value sum = deformation.f[i][0] * crosses[pair][0];
        MESHORDER_UNROLL
        for (int j = 1; j < 3 - pair; ++j) sum = Lanes::mul_add(deformation.f[i][j], crosses[pair][j], sum);
        turn[pair][i] = of_turn * sum;
      }
    }
  }

  HWY_INLINE void block(int a, int b, Value (&k)[9]) const {
    fill_block(a == b, k, [&](int i, int j) MESHORDER_INLINE_LAMBDA {
      const Value sum = Lanes::mul_add(weighted_p[a][i], p[b][j], weighted_q[a][i] * q[b][j]);
      return i == j ? sum + material[a][b] : sum;
    });
    if (a == b) return;
    // −[w]× has w₂ in row 0, column 1; the other entries follow by cyclic permutation
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const Value w = turn[a + b - 1][(i + 2) % 3];
      k[3 * i + j] = k[3 * i + j] + w;
      k[3 * j + i] = k[3 * j + i] - w;
    }
  }
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
