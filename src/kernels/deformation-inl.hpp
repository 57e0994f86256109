// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_DEFORMATION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_DEFORMATION_INL
#undef MESHORDER_DEFORMATION_INL
#else
#define MESHORDER_DEFORMATION_INL
#endif

#include "kernels/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// The deformation of Lanes::kCount simplices of dimension D.
template <int D, class Lanes>
struct Deformation {
  using Value = typename Lanes::Value;
  /// The shape gradients of the corners 1 … D in the simplex's own frame: the rows of Dₘ⁻¹, upper triangle
  /// only. The gradient of corner 0 is minus their sum.
  Value g[D][D];
  Value volume;
  Value f[3][D];  ///< deformation gradient F

  HWY_INLINE void load(const double* geometry, const Index* vertices, const double* positions) {
    int q = 0;
    MESHORDER_UNROLL
    for (int i = 0; i < D; ++i) {
      MESHORDER_UNROLL
      for (int j = i; j < D; ++j) g[i][j] = Lanes::load(geometry + q++ * kBatch);
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
          f[c][j] = a == 0 ? edge[c] * g[0][j] : Lanes::mul_add(edge[c], g[a][j], f[c][j]);
        }
      }
    }
  }

  /// Returns g_a · g_b for two of the corners 1 … D, numbered from 0.
  [[nodiscard]] HWY_INLINE Value gradients(int a, int b) const {
    const int from = a > b ? a : b;
    Value sum = g[a][from] * g[b][from];
    MESHORDER_UNROLL
    for (int j = from + 1; j < D; ++j) sum = Lanes::mul_add(g[a][j], g[b][j], sum);
    return sum;
  }

  /// Computes p = M g_a for a 3×D matrix M and one of the corners 1 … D, numbered from 0.
  HWY_INLINE void times_gradient(const Value (&m)[3][D], int a, Value (&p)[3]) const {
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      p[c] = m[c][a] * g[a][a];
      MESHORDER_UNROLL
      for (int j = a + 1; j < D; ++j) p[c] = Lanes::mul_add(m[c][j], g[a][j], p[c]);
    }
  }

  /// Adds the forces of a first Piola–Kirchhoff stress P to the targets: −V P g_a on corner a.
  HWY_INLINE void add_forces(const Value (&stress)[3][D], const Index* targets, double* forces) const {
    Value corner[D][3];
    Value at_origin[3];
    const Value minus_volume = Lanes::set(0.0) - volume;
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      MESHORDER_UNROLL
      for (int j = 0; j < D; ++j) {
        const Value weighted = stress[c][j] * minus_volume;
        MESHORDER_UNROLL
        for (int a = 0; a <= j; ++a) {
          corner[a][c] = a == j ? weighted * g[a][j] : Lanes::mul_add(weighted, g[a][j], corner[a][c]);
        }
      }
      at_origin[c] = Lanes::set(0.0);
      MESHORDER_UNROLL
      for (int a = 0; a < D; ++a) at_origin[c] = at_origin[c] - corner[a][c];
    }
    Lanes::scatter_add(at_origin, targets, forces);
    MESHORDER_UNROLL
    for (int a = 0; a < D; ++a) Lanes::scatter_add(corner[a], targets + (a + 1) * kBatch, forces);
  }
};

/// Lamé's parameters of Lanes::kCount simplices.
template <class Lanes>
struct LameLanes {
  typename Lanes::Value mu, lambda;
};

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
