// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_ELEMENT_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_ELEMENT_BLOCKS_INL
#undef MESHORDER_ELEMENT_BLOCKS_INL
#else
#define MESHORDER_ELEMENT_BLOCKS_INL
#endif

#include "kernels/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// The stiffness blocks of a batch of simplices. Blocks are computed for many simplices at a time; this
/// buffer holds them until they are added to the matrix, one simplex at a time.
template <int D>
struct ElementBlocks {
  static constexpr int kBlocks = (D + 1) * (D + 1);
  alignas(64) double head[kBatch][kBlocks][8];  ///< the first eight of a block's nine entries
  alignas(64) double last[kBlocks][kBatch];

  /// Stores block (a, b) and its transpose, block (b, a), of the simplices from `lane` on.
  template <class Lanes>
  HWY_INLINE void put(int a, int b, const typename Lanes::Value (&k)[9], Index lane) {
    using Value = typename Lanes::Value;
    const int ab = a * (D + 1) + b;
    put_head<Lanes>(ab, k, lane);
    Lanes::store(k[8], last[ab] + lane);
    if (a == b) return;
    const int ba = b * (D + 1) + a;
    const Value transposed[8] = {k[0], k[3], k[6], k[1], k[4], k[7], k[2], k[5]};
    put_head<Lanes>(ba, transposed, lane);
    Lanes::store(k[8], last[ba] + lane);
  }

  /// Prefetches the blocks that a simplex will add to, one batch in advance. Hardware does not prefetch them,
  /// because they are scattered over the matrix. In measurements, prefetching halved the time for which
  /// assembly waits for memory.
  static HWY_INLINE void fetch(const Index* blocks, const double* values) {
    for (int block = 0; block < kBlocks; ++block) {
      const double* const place = values + Offset{9} * blocks[block];
      hwy::Prefetch(place);
      hwy::Prefetch(place + 8);
    }
  }

  /// Adds the blocks of one simplex to those of a matrix.
  HWY_INLINE void add(Index lane, const Index* blocks, double* values) const {
    using Tag = hn::CappedTag<double, 8>;
    const Tag d;
    MESHORDER_UNROLL
    for (int block = 0; block < kBlocks; ++block) {
      double* const place = values + Offset{9} * blocks[block];
      MESHORDER_UNROLL
      for (Index k = 0; k < 8; k += static_cast<Index>(MaxLanes(d))) {
        hn::StoreU(hn::Add(hn::LoadU(d, place + k), hn::Load(d, head[lane][block] + k)), d, place + k);
      }
      place[8] += last[block][lane];
    }
  }

 private:
  template <class Lanes>
  HWY_INLINE void put_head(int block, const typename Lanes::Value* k, Index lane) {
    MESHORDER_UNROLL
    for (Index first = 0; first < 8; first += Lanes::kCount) {
      Lanes::store_transposed(k + first, head[lane][block] + first, Offset{8} * kBlocks);
    }
  }
};

/// Computes all blocks of some simplices. `tangent` computes the blocks of the corners 1 … D (numbered from
/// 0). A translation changes no force, so every row of blocks adds up to zero; this gives the blocks of
/// corner 0.
template <int D, class Lanes, class Tangent>
HWY_INLINE void compute_blocks(const Tangent& tangent, Index lane, ElementBlocks<D>& out) {
  using Value = typename Lanes::Value;
  Value of_origin[D][9];  // block (0, b)
  MESHORDER_UNROLL
  for (int b = 0; b < D; ++b) {
    MESHORDER_UNROLL
    for (int k = 0; k < 9; ++k) of_origin[b][k] = Lanes::set(0.0);
  }
  MESHORDER_UNROLL
  for (int a = 0; a < D; ++a) {
    MESHORDER_UNROLL
    for (int b = a; b < D; ++b) {
      Value block[9];
      tangent.block(a, b, block);
      out.template put<Lanes>(a + 1, b + 1, block, lane);
      MESHORDER_UNROLL
      for (int k = 0; k < 9; ++k) {
        of_origin[b][k] = of_origin[b][k] - block[k];
        if (a != b) of_origin[a][k] = of_origin[a][k] - block[k % 3 * 3 + k / 3];
      }
    }
  }
  Value corner[9];
  MESHORDER_UNROLL
  for (int b = 0; b < D; ++b) {
    out.template put<Lanes>(0, b + 1, of_origin[b], lane);
    MESHORDER_UNROLL
    for (int k = 0; k < 9; ++k) {
      corner[k] = b == 0 ? Lanes::set(0.0) - of_origin[0][k] : corner[k] - of_origin[b][k];
    }
  }
  // symmetric to the last bit
  corner[3] = corner[1];
  corner[6] = corner[2];
  corner[7] = corner[5];
  out.template put<Lanes>(0, 0, corner, lane);
}

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
