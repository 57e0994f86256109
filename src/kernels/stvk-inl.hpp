// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_STVK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_STVK_INL
#undef MESHORDER_STVK_INL
#else
#define MESHORDER_STVK_INL
#endif

#include "kernels/deformation-inl.hpp"
#include "kernels/matrix-inl.hpp"
#include "kernels/projected-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Saint Venant–Kirchhoff for solids, membranes and bars: E = ½(FᵀF − I), S = 2μE + λ tr(E) I, P = F S.
template <int D, class Lanes>
struct Stvk {
  using Value = typename Lanes::Value;
  Value e[D][D];  ///< Green strain, upper triangle
  Value s[D][D];  ///< second Piola–Kirchhoff stress, both triangles

  HWY_INLINE void load(const Deformation<D, Lanes>& deformation, const LameLanes<Lanes>& lame) {
    const auto& f = deformation.f;
    const Value half = Lanes::set(0.5);
    const Value two_mu = lame.mu + lame.mu;
    MESHORDER_UNROLL
    for (int i = 0; i < D; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < D; ++j) {
        Value product = Lanes::mul_add(f[2][i], f[2][j], i == j ? Lanes::set(-1.0) : Lanes::set(0.0));
        product = Lanes::mul_add(f[1][i], f[1][j], product);
        e[i][j] = half * Lanes::mul_add(f[0][i], f[0][j], product);
      }
    }
    const Value pressure = lame.lambda * trace();
    MESHORDER_UNROLL
    for (int i = 0; i < D; ++i) {
      s[i][i] = Lanes::mul_add(two_mu, e[i][i], pressure);
      MESHORDER_UNROLL
      for (int j = i + 1; j < D; ++j) s[i][j] = s[j][i] = two_mu * e[i][j];
    }
  }

  [[nodiscard]] HWY_INLINE Value trace() const {
    Value sum = e[0][0];
    MESHORDER_UNROLL
    for (int i = 1; i < D; ++i) sum = sum + e[i][i];
    return sum;
  }

  HWY_INLINE void stress(const Deformation<D, Lanes>& deformation, const LameLanes<Lanes>& /*lame*/,
                         Value (&p)[3][D]) const {
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      MESHORDER_UNROLL
      for (int j = 0; j < D; ++j) {
        p[c][j] = deformation.f[c][0] * s[0][j];
        MESHORDER_UNROLL
        for (int k = 1; k < D; ++k) p[c][j] = Lanes::mul_add(deformation.f[c][k], s[k][j], p[c][j]);
      }
    }
  }

  /// Returns the energy density μ E:E + ½ λ tr(E)².
  [[nodiscard]] HWY_INLINE Value energy(const Deformation<D, Lanes>& /*deformation*/,
                                        const LameLanes<Lanes>& lame) const {
    Value squares = Lanes::set(0.0);
    MESHORDER_UNROLL
    for (int i = 0; i < D; ++i) {
      squares = Lanes::mul_add(e[i][i], e[i][i], squares);
      MESHORDER_UNROLL
      for (int j = i + 1; j < D; ++j) squares = Lanes::mul_add(e[i][j] + e[i][j], e[i][j], squares);
    }
    const Value t = trace();
    return Lanes::mul_add(lame.mu, squares, Lanes::set(0.5) * lame.lambda * (t * t));
  }

  /// Sets the Hessian in principal stretches; the energy's derivatives are ψᵢ = σᵢ (μ (σᵢ² − 1) + λ tr(E)).
  HWY_INLINE void principal(const Value (&sigma)[3], const LameLanes<Lanes>& lame,
                            PrincipalHessian<Lanes>& hessian) const {
    const Value one = Lanes::set(1.0);
    const Value three = Lanes::set(3.0);
    const Value pressure = lame.lambda * trace();
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      const Value& a = sigma[(k + 1) % 3];
      const Value& b = sigma[(k + 2) % 3];
      const Value squares = Lanes::mul_add(a, a, b * b) - one;
      hessian.twist[k] = Lanes::mul_add(lame.mu, squares - a * b, pressure);
      hessian.flip[k] = Lanes::mul_add(lame.mu, squares + a * b, pressure);
      const Value square = sigma[k] * sigma[k];
      hessian.stretch[k][k] =
          Lanes::mul_add(lame.lambda, square, Lanes::mul_add(lame.mu, three * square - one, pressure));
      MESHORDER_UNROLL
      for (int j = k + 1; j < 3; ++j) hessian.stretch[k][j] = lame.lambda * sigma[k] * sigma[j];
    }
  }
};

/// The exact tangent: K_ab = V ((g_a·S g_b) I + λ p_a p_bᵀ + μ p_b p_aᵀ + μ (g_a·g_b) F Fᵀ) with p_a = F g_a.
/// It follows from δF = δx_b g_bᵀ.
template <int D, class Lanes>
struct StvkTangent {
  using Value = typename Lanes::Value;
  Value p[D][3];
  Value lambda_p[D][3];
  Value mu_p[D][3];
  Value mu_fft[6];  ///< μ F Fᵀ: 00 01 02 11 12 22
  Value material[D][D];
  Value geometric[D][D];

  HWY_INLINE void load(const Deformation<D, Lanes>& deformation, const Stvk<D, Lanes>& stvk,
                       const LameLanes<Lanes>& lame, Value weight) {
    const Value mu = lame.mu * weight;
    const Value lambda = lame.lambda * weight;
    MESHORDER_UNROLL
    for (int a = 0; a < D; ++a) {
      deformation.times_gradient(deformation.f, a, p[a]);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) {
        mu_p[a][c] = mu * p[a][c];
        lambda_p[a][c] = lambda * p[a][c];
      }
      Value sg[D];
      MESHORDER_UNROLL
      for (int j = 0; j < D; ++j) {
        sg[j] = stvk.s[j][a] * deformation.g[a][a];
        MESHORDER_UNROLL
        for (int k = a + 1; k < D; ++k) sg[j] = Lanes::mul_add(stvk.s[j][k], deformation.g[a][k], sg[j]);
      }
      MESHORDER_UNROLL
      for (int b = a; b < D; ++b) {
        material[a][b] = deformation.gradients(a, b);
        geometric[a][b] = sg[b] * deformation.g[b][b];
        MESHORDER_UNROLL
        for (int j = b + 1; j < D; ++j) {
          geometric[a][b] = Lanes::mul_add(sg[j], deformation.g[b][j], geometric[a][b]);
        }
        geometric[a][b] = weight * geometric[a][b];
      }
    }
    int entry = 0;
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < 3; ++j) {
        Value sum = deformation.f[i][0] * deformation.f[j][0];
        MESHORDER_UNROLL
        for (int k = 1; k < D; ++k) sum = Lanes::mul_add(deformation.f[i][k], deformation.f[j][k], sum);
        mu_fft[entry++] = mu * sum;
      }
    }
  }

  HWY_INLINE void block(int a, int b, Value (&k)[9]) const {
    constexpr int kSymmetric[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    fill_block(a == b, k, [&](int i, int j) MESHORDER_INLINE_LAMBDA {
      Value sum = Lanes::mul_add(lambda_p[a][i], p[b][j], mu_p[b][i] * p[a][j]);
      sum = Lanes::mul_add(material[a][b], mu_fft[kSymmetric[3 * i + j]], sum);
      return i == j ? sum + geometric[a][b] : sum;
    });
  }
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
