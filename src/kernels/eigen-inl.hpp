// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_EIGEN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_EIGEN_INL
#undef MESHORDER_EIGEN_INL
#else
#define MESHORDER_EIGEN_INL
#endif

#include "kernels/lanes-inl.hpp"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Applies one rotation of Jacobi's method in the plane of p and q, which zeroes a_pq. The matrix is
/// symmetric; only its upper triangle is used.
template <int N, class Lanes>
HWY_INLINE void rotate_plane(int p, int q, typename Lanes::Value (&a)[N][N],
                             typename Lanes::Value (&vectors)[N][N]) {
  using Value = typename Lanes::Value;
  constexpr double kSmallest = std::is_same_v<typename Lanes::Number, float> ? 1e-37 : 1e-300;
  const Value one = Lanes::set(1.0);
  const Value twice = a[p][q] + a[p][q];
  const Value difference = a[q][q] - a[p][p];
  // the smaller root of t² + t (a_qq − a_pp) / a_pq − 1 = 0; 0 if a_pq is 0 already
  const Value root = Lanes::square_root(Lanes::mul_add(difference, difference, twice * twice));
  const Value t = Lanes::with_sign_of(one, difference) * twice /
                  Lanes::max(Lanes::abs(difference) + root, Lanes::set(kSmallest));
  const Value c = one / Lanes::square_root(Lanes::mul_add(t, t, one));
  const Value s = t * c;
  a[p][p] = a[p][p] - t * a[p][q];
  a[q][q] = Lanes::mul_add(t, a[p][q], a[q][q]);
  a[p][q] = Lanes::set(0.0);
  MESHORDER_UNROLL
  for (int k = 0; k < N; ++k) {
    if (k != p && k != q) {
      Value& kp = k < p ? a[k][p] : a[p][k];
      Value& kq = k < q ? a[k][q] : a[q][k];
      const Value old = kp;
      kp = c * old - s * kq;
      kq = Lanes::mul_add(s, old, c * kq);
    }
    const Value old = vectors[k][p];
    vectors[k][p] = c * old - s * vectors[k][q];
    vectors[k][q] = Lanes::mul_add(s, old, c * vectors[k][q]);
  }
}

/// Computes eigenvalues and orthonormal eigenvectors (the columns of `vectors`) of symmetric N×N matrices, N
/// = 3 or 4, by Jacobi's cyclic method. For any matrix, the only errors are rounding errors relative to the
/// largest entry. The function also ends for NaN. Squares of entries must not underflow or overflow.
/// Overwrites the upper triangle of `a`.
template <int N, class Lanes>
HWY_INLINE void symmetric_eigen(typename Lanes::Value (&a)[N][N], typename Lanes::Value (&values)[N],
                                typename Lanes::Value (&vectors)[N][N]) {
  using Value = typename Lanes::Value;
  // convergence is quadratic: usually three or four sweeps; twice as many were never observed
  constexpr int kSweeps = 10;
  constexpr double kNegligible = std::is_same_v<typename Lanes::Number, float> ? 1e-16 : 1e-34;
  MESHORDER_UNROLL
  for (int i = 0; i < N; ++i) {
    MESHORDER_UNROLL
    for (int j = 0; j < N; ++j) vectors[i][j] = Lanes::set(i == j ? 1.0 : 0.0);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    Value off = Lanes::set(0.0);
    Value all = Lanes::set(0.0);
    MESHORDER_UNROLL
    for (int i = 0; i < N; ++i) {
      all = Lanes::mul_add(a[i][i], a[i][i], all);
      MESHORDER_UNROLL
      for (int j = i + 1; j < N; ++j) off = Lanes::mul_add(a[i][j], a[i][j], off);
    }
    if (Lanes::all_at_most(off - Lanes::set(kNegligible) * all, 0.0)) break;
    MESHORDER_UNROLL
    for (int p = 0; p < N; ++p) {
      MESHORDER_UNROLL
      for (int q = p + 1; q < N; ++q) rotate_plane<N, Lanes>(p, q, a, vectors);
    }
  }
  MESHORDER_UNROLL
  for (int i = 0; i < N; ++i) values[i] = a[i][i];
}

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
