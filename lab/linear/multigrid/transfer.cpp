// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/level.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/linear/multigrid/transfer.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "lab/linear/multigrid/block_sweeps-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

// A block of the prolongation, R×6 row by row, is also a block of the transpose, 6×R column by column.

template <int R>
HWY_INLINE void restrict_columns(const Prolongation<R>& p, const ColumnBlocks& transposed,
                                 const float* residual, Index begin, Index end, float* result) {
  for (Index a = begin; a < end; ++a) {
    auto sum = ProductSum<kRigidModes, R>::zero();
    // the blocks of an aggregate's members are not adjacent in memory
    if (a + 1 < end) {
      for (Offset k = transposed.offsets[a + 1]; k < transposed.offsets[a + 2]; ++k) {
        __builtin_prefetch(p.block(transposed.blocks[k]));
        __builtin_prefetch(p.block(transposed.blocks[k]) + 16);
      }
    }
    for (Offset k = transposed.offsets[a]; k < transposed.offsets[a + 1]; ++k) {
      sum.add(p.block(transposed.blocks[k]), residual + Offset{Node<R>::kStride} * transposed.rows[k]);
    }
    sum.total().clean().store(result + Offset{Node<kRigidModes>::kStride} * a);
  }
}

template <int R>
HWY_INLINE void prolong_rows(const Prolongation<R>& p, const float* correction, Index begin, Index end,
                             float* x) {
  for (Index i = begin; i < end; ++i) {
    for (Offset k = p.offsets[i]; k < p.offsets[i + 1]; ++k) {
      const auto coarse =
          Node<kRigidModes>::load(correction + Offset{Node<kRigidModes>::kStride} * p.columns[k]);
      add_transposed_product<kRigidModes, R>(p.block(k), coarse, x + Offset{Node<R>::kStride} * i);
    }
  }
}

void restrict_3(const Prolongation<3>& p, const ColumnBlocks& transposed, const float* residual, Index begin,
                Index end, float* result) {
  restrict_columns(p, transposed, residual, begin, end, result);
}
void restrict_6(const Prolongation<6>& p, const ColumnBlocks& transposed, const float* residual, Index begin,
                Index end, float* result) {
  restrict_columns(p, transposed, residual, begin, end, result);
}
void prolong_3(const Prolongation<3>& p, const float* correction, Index begin, Index end, float* x) {
  prolong_rows(p, correction, begin, end, x);
}
void prolong_6(const Prolongation<6>& p, const float* correction, Index begin, Index end, float* x) {
  prolong_rows(p, correction, begin, end, x);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(restrict_3);
MESHORDER_SIMD_VERSIONS(restrict_6);
MESHORDER_SIMD_VERSIONS(prolong_3);
MESHORDER_SIMD_VERSIONS(prolong_6);

}  // namespace

template <int R>
void restrict_residual(const MultigridLevel<R>& level, const AlignedVector<float>& residual,
                       AlignedVector<float>& result) {
  constexpr Index kColumns = 512;
  const Prolongation<R>& p = level.prolongation;
  for_each_chunk(p.columns_count, kColumns, [&](Index, Index begin, Index end) {
    if constexpr (R == 3) {
      MESHORDER_SIMD(restrict_3)(p, level.transposed, residual.data(), begin, end, result.data());
    } else {
      MESHORDER_SIMD(restrict_6)(p, level.transposed, residual.data(), begin, end, result.data());
    }
  });
}

template <int R>
void add_prolonged(const MultigridLevel<R>& level, const AlignedVector<float>& correction,
                   AlignedVector<float>& x) {
  constexpr Index kRows = 4096;
  const Prolongation<R>& p = level.prolongation;
  for_each_chunk(p.rows(), kRows, [&](Index, Index begin, Index end) {
    if constexpr (R == 3) MESHORDER_SIMD(prolong_3)(p, correction.data(), begin, end, x.data());
    if constexpr (R == 6) MESHORDER_SIMD(prolong_6)(p, correction.data(), begin, end, x.data());
  });
}

template void restrict_residual(const MultigridLevel<3>&, const AlignedVector<float>&, AlignedVector<float>&);
template void restrict_residual(const MultigridLevel<6>&, const AlignedVector<float>&, AlignedVector<float>&);
template void add_prolonged(const MultigridLevel<3>&, const AlignedVector<float>&, AlignedVector<float>&);
template void add_prolonged(const MultigridLevel<6>&, const AlignedVector<float>&, AlignedVector<float>&);

}  // namespace meshorder
#endif
