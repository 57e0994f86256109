// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_ROTATION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_ROTATION_INL
#undef MESHORDER_ROTATION_INL
#else
#define MESHORDER_ROTATION_INL
#endif

#include <meshorder/sim/material/eigen-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// The rotations closest to 3×3 matrices, which maximise R:F over det R = 1: see closest_rotation.
///
/// As unit quaternions q they maximise qᵀN q of a symmetric 4×4 matrix N that is linear in F (Davenport;
/// Horn 1987), so that an eigenvector of its largest eigenvalue answers for every F.
template <class Lanes>
HWY_INLINE void closest_rotations(const typename Lanes::Value (&f)[3][3], typename Lanes::Value (&r)[3][3]) {
  using Value = typename Lanes::Value;
  const Value zero = Lanes::set(0.0);
  const Value one = Lanes::set(1.0);
  // at most 1 in size, so that no square overflows or vanishes: R does not see the scale
  Value largest = Lanes::abs(f[0][0]);
  Value not_finite = zero * f[0][0];  // NaN where an entry is infinite or NaN, else 0
  MESHORDER_UNROLL
  for (int k = 1; k < 9; ++k) {
    largest = Lanes::max(largest, Lanes::abs(f[k / 3][k % 3]));
    not_finite = not_finite + zero * f[k / 3][k % 3];
  }
  const Value scale = one / Lanes::max(largest, Lanes::set(1e-290));
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
  // of equal ones the first: the identity for F = 0
  Value greatest = values[0];
  Value q[4] = {vectors[0][0], vectors[1][0], vectors[2][0], vectors[3][0]};
  MESHORDER_UNROLL
  for (int v = 1; v < 4; ++v) {
    const Value above = values[v] - greatest;
    greatest = Lanes::choose(above, values[v], greatest);
    MESHORDER_UNROLL
    for (int k = 0; k < 4; ++k) q[k] = Lanes::choose(above, vectors[k][v], q[k]);
  }

  // 2 / ‖q‖² where a rotation's matrix has 2
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

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
