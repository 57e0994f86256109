// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_MATRIX_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_MATRIX_INL
#undef MESHORDER_MATRIX_INL
#else
#define MESHORDER_MATRIX_INL
#endif

#include "kernels/lanes-inl.hpp"

/// Attributes for a lambda in a kernel: compiled for the kernel's instruction set, and always inlined.
#undef MESHORDER_INLINE_LAMBDA
#define MESHORDER_INLINE_LAMBDA __attribute__((always_inline)) HWY_ATTR

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Computes cof F, the transpose of F⁻¹ det F.
template <class Lanes>
HWY_INLINE void cofactors(const typename Lanes::Value (&f)[3][3], typename Lanes::Value (&cof)[3][3]) {
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    MESHORDER_UNROLL
    for (int j = 0; j < 3; ++j) {
      cof[i][j] = f[(i + 1) % 3][(j + 1) % 3] * f[(i + 2) % 3][(j + 2) % 3] -
                  f[(i + 1) % 3][(j + 2) % 3] * f[(i + 2) % 3][(j + 1) % 3];
    }
  }
}

/// Fills a 3×3 block: k[3i + j] = entry(i, j). If `symmetric`, the lower triangle is copied from the upper.
template <class Value, class Entry>
HWY_INLINE void fill_block(bool symmetric, Value (&k)[9], Entry entry) {
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    MESHORDER_UNROLL
    for (int j = 0; j < 3; ++j) k[3 * i + j] = symmetric && j < i ? k[3 * j + i] : entry(i, j);
  }
}

/// Returns A : B = Σ aᵢⱼ bᵢⱼ.
template <class Lanes, int D>
HWY_INLINE typename Lanes::Value contract(const typename Lanes::Value (&a)[3][D],
                                          const typename Lanes::Value (&b)[3][D]) {
  typename Lanes::Value sum = a[0][0] * b[0][0];
  MESHORDER_UNROLL
  for (int k = 1; k < 3 * D; ++k) sum = Lanes::mul_add(a[k / D][k % D], b[k / D][k % D], sum);
  return sum;
}

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
