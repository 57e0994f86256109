// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_PROJECTED_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_PROJECTED_INL
#undef MESHORDER_PROJECTED_INL
#else
#define MESHORDER_PROJECTED_INL
#endif

#include "kernels/deformation-inl.hpp"
#include "kernels/matrix-inl.hpp"
#include "kernels/rotation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// The Hessian of an isotropic law in its principal axes, at the signed singular values σ. Index k of `twist`
/// and `flip` means the pair (i, j) of the two axes other than k.
template <class Lanes>
struct PrincipalHessian {
  using Value = typename Lanes::Value;
  Value stretch[3][3];  ///< ∂²Ψ/∂σᵢ∂σⱼ, upper triangle
  Value twist[3];       ///< (ψᵢ + ψⱼ) / (σᵢ + σⱼ), ψ = ∂Ψ/∂σ
  Value flip[3];        ///< (ψᵢ − ψⱼ) / (σᵢ − σⱼ)
};

/// The positive semi-definite part of the Hessian, by its eigenvectors in closed form (Smith, De Goes, Kim
/// 2019). With F = U Σ Vᵀ the eigenvectors are these matrices, rotated by U and V:
/// - three symmetric matrices with two equal entries (flips);
/// - three antisymmetric matrices (twists);
/// - three diagonal matrices, the eigenvectors of ∂²Ψ/∂σᵢ∂σⱼ.
///
/// Negative eigenvalues become 0. `Law` has principal(σ, lame, hessian).
template <class Lanes, class Law>
struct ProjectedTangent {
  using Value = typename Lanes::Value;
  Value u[3][3];        ///< U
  Value h[3][3];        ///< h_a = Vᵀ g_a of the corners 1, 2, 3
  Value stretch[3][3];  ///< ∂²Ψ/∂σᵢ∂σⱼ without negative eigenvalues, weighted; both triangles
  Value alike[3];       ///< ½ (flip + twist), weighted: couples an entry of δF in principal axes to itself
  Value across[3];      ///< ½ (flip − twist), weighted: couples such an entry to the transposed one

  HWY_INLINE void load(const Deformation<3, Lanes>& deformation, const Law& law, const LameLanes<Lanes>& lame,
                       Value weight) {
    Value sigma[3];
    principal_axes(deformation, sigma);
    PrincipalHessian<Lanes> hessian;
    law.principal(sigma, lame, hessian);
    clamp_stretch(hessian.stretch, weight);
    const Value zero = Lanes::set(0.0);
    const Value half = Lanes::set(0.5) * weight;
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) {
      const Value twist = half * Lanes::max(hessian.twist[k], zero);
      const Value flip = half * Lanes::max(hessian.flip[k], zero);
      alike[k] = flip + twist;
      across[k] = flip - twist;
    }
  }

  HWY_INLINE void block(int a, int b, Value (&k)[9]) const {
    Value principal[3][3];
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int l = (i + 2) % 3;
      Value sum = stretch[i][i] * (h[a][i] * h[b][i]);
      sum = Lanes::mul_add(alike[l], h[a][j] * h[b][j], sum);
      principal[i][i] = Lanes::mul_add(alike[j], h[a][l] * h[b][l], sum);
      principal[i][j] = Lanes::mul_add(across[l], h[a][j] * h[b][i], stretch[i][j] * (h[a][i] * h[b][j]));
      principal[j][i] = Lanes::mul_add(across[l], h[a][i] * h[b][j], stretch[i][j] * (h[a][j] * h[b][i]));
    }
    Value turned[3][3];
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = 0; j < 3; ++j) {
        turned[i][j] = u[i][0] * principal[0][j];
        turned[i][j] = Lanes::mul_add(u[i][1], principal[1][j], turned[i][j]);
        turned[i][j] = Lanes::mul_add(u[i][2], principal[2][j], turned[i][j]);
      }
    }
    fill_block(a == b, k, [&](int i, int j) MESHORDER_INLINE_LAMBDA {
      Value sum = turned[i][0] * u[j][0];
      sum = Lanes::mul_add(turned[i][1], u[j][1], sum);
      return Lanes::mul_add(turned[i][2], u[j][2], sum);
    });
  }

 private:
  /// Computes F = U Σ Vᵀ from F = R S and S = V Σ Vᵀ. Only the smallest singular value may be negative.
  HWY_INLINE void principal_axes(const Deformation<3, Lanes>& deformation, Value (&sigma)[3]) {
    const auto& f = deformation.f;
    Value r[3][3];
    closest_rotations<Lanes>(f, r);
    Value s[3][3];
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < 3; ++j) {
        Value sum = Lanes::mul_add(r[0][i], f[0][j], r[0][j] * f[0][i]);
        sum = Lanes::mul_add(r[1][i], f[1][j], Lanes::mul_add(r[1][j], f[1][i], sum));
        sum = Lanes::mul_add(r[2][i], f[2][j], Lanes::mul_add(r[2][j], f[2][i], sum));
        s[i][j] = Lanes::set(0.5) * sum;
      }
    }
    Value v[3][3];
    symmetric_eigen<3, Lanes>(s, sigma, v);
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = 0; j < 3; ++j) {
        u[i][j] = r[i][0] * v[0][j];
        u[i][j] = Lanes::mul_add(r[i][1], v[1][j], u[i][j]);
        u[i][j] = Lanes::mul_add(r[i][2], v[2][j], u[i][j]);
      }
    }
    MESHORDER_UNROLL
    for (int a = 0; a < 3; ++a) {
      MESHORDER_UNROLL
      for (int i = 0; i < 3; ++i) {
        h[a][i] = v[a][i] * deformation.g[a][a];
        MESHORDER_UNROLL
        for (int j = a + 1; j < 3; ++j) h[a][i] = Lanes::mul_add(v[j][i], deformation.g[a][j], h[a][i]);
      }
    }
  }

  HWY_INLINE void clamp_stretch(Value (&matrix)[3][3], Value weight) {
    Value values[3];
    Value vectors[3][3];
    symmetric_eigen<3, Lanes>(matrix, values, vectors);
    MESHORDER_UNROLL
    for (Value& value : values) value = weight * Lanes::max(value, Lanes::set(0.0));
    MESHORDER_UNROLL
    for (int i = 0; i < 3; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < 3; ++j) {
        Value sum = values[0] * (vectors[i][0] * vectors[j][0]);
        sum = Lanes::mul_add(values[1], vectors[i][1] * vectors[j][1], sum);
        stretch[i][j] = stretch[j][i] = Lanes::mul_add(values[2], vectors[i][2] * vectors[j][2], sum);
      }
    }
  }
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
