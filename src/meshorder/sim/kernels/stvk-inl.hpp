// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_OLD_STVK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_OLD_STVK_INL
#undef MESHORDER_OLD_STVK_INL
#else
#define MESHORDER_OLD_STVK_INL
#endif

#include <meshorder/sim/kernels/element_force.hpp>
#include <meshorder/sim/kernels/lanes-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// The state of Lanes::kCount simplices of dimension D: all that forces and tangents are made of.
/// Saint Venant–Kirchhoff: E = ½(FᵀF − I), S = 2μE + λ tr(E) I, P = F S.
template <int D, class Lanes>
struct OldStvk {
  using Value = typename Lanes::Value;
  Value inverse[D][D];  ///< Dₘ⁻¹, upper triangle only
  Value volume;
  Value f[3][D];  ///< deformation gradient F
  Value e[D][D];  ///< Green strain, upper triangle
  Value s[D][D];  ///< second Piola–Kirchhoff stress, all of it

  HWY_INLINE void load(const double* geometry, const Index* vertices, const double* positions) {
    int q = 0;
    MESHORDER_UNROLL
    for (int i = 0; i < D; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < D; ++j) inverse[i][j] = Lanes::load(geometry + q++ * kBatch);
    }
    volume = Lanes::load(geometry + q * kBatch);

    // F = Dₛ Dₘ⁻¹
    Value origin[3];
    Lanes::gather(positions, vertices, origin);
    MESHORDER_UNROLL
    for (int a = 0; a < D; ++a) {
      Value edge[3];
      Lanes::gather(positions, vertices + (a + 1) * kBatch, edge);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) {
        edge[c] = edge[c] - origin[c];
        MESHORDER_UNROLL
        for (int j = a; j < D; ++j) {
          f[c][j] = a == 0 ? edge[c] * inverse[0][j] : Lanes::mul_add(edge[c], inverse[a][j], f[c][j]);
        }
      }
    }
  }

  HWY_INLINE void strain_and_stress(const Lame& lame) {
    const Value half = Lanes::set(0.5);
    const Value two_mu = Lanes::set(2.0 * lame.mu);
    MESHORDER_UNROLL
    for (int i = 0; i < D; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < D; ++j) {
        Value product = Lanes::mul_add(f[2][i], f[2][j], i == j ? Lanes::set(-1.0) : Lanes::set(0.0));
        product = Lanes::mul_add(f[1][i], f[1][j], product);
        e[i][j] = half * Lanes::mul_add(f[0][i], f[0][j], product);
      }
    }
    const Value pressure = Lanes::set(lame.lambda) * trace();
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

  /// V (μ E:E + ½ λ tr(E)²)
  [[nodiscard]] HWY_INLINE Value energy(const Lame& lame) const {
    Value squares = Lanes::set(0.0);
    MESHORDER_UNROLL
    for (int i = 0; i < D; ++i) {
      squares = Lanes::mul_add(e[i][i], e[i][i], squares);
      MESHORDER_UNROLL
      for (int j = i + 1; j < D; ++j) squares = Lanes::mul_add(e[i][j] + e[i][j], e[i][j], squares);
    }
    const Value t = trace();
    return volume * Lanes::mul_add(Lanes::set(lame.mu), squares, Lanes::set(0.5 * lame.lambda) * (t * t));
  }

  /// The force on corner a is −V P g_a, with g_a row a − 1 of Dₘ⁻¹ and g₀ minus their sum.
  HWY_INLINE void add_forces(const Index* vertices, double* forces) const {
    Value corner[D][3];
    Value at_origin[3];
    const Value minus_volume = Lanes::set(0.0) - volume;
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      MESHORDER_UNROLL
      for (int j = 0; j < D; ++j) {
        Value stress = f[c][0] * s[0][j];
        MESHORDER_UNROLL
        for (int k = 1; k < D; ++k) stress = Lanes::mul_add(f[c][k], s[k][j], stress);
        stress = stress * minus_volume;
        MESHORDER_UNROLL
        for (int a = 0; a <= j; ++a) {
          corner[a][c] =
              a == j ? stress * inverse[a][j] : Lanes::mul_add(stress, inverse[a][j], corner[a][c]);
        }
      }
      at_origin[c] = Lanes::set(0.0);
      MESHORDER_UNROLL
      for (int a = 0; a < D; ++a) at_origin[c] = at_origin[c] - corner[a][c];
    }
    Lanes::scatter_add(at_origin, vertices, forces);
    MESHORDER_UNROLL
    for (int a = 0; a < D; ++a) Lanes::scatter_add(corner[a], vertices + (a + 1) * kBatch, forces);
  }
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
