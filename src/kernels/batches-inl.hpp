// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set, as lanes-inl.hpp is.
#if defined(MESHORDER_BATCHES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_BATCHES_INL
#undef MESHORDER_BATCHES_INL
#else
#define MESHORDER_BATCHES_INL
#endif

#include "kernels/deformation-inl.hpp"
#include "kernels/element_blocks-inl.hpp"
#include "kernels/pass.hpp"

#include <algorithm>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {

/// Takes the place of a Tangent if only forces are computed.
struct NoTangent {};

template <int D>
HWY_INLINE const double* geometry_of(const RestShapes& rest, Offset batch) {
  return rest.geometry.data() + batch * kBatch * (D * (D + 1) / 2 + 1);
}

template <int D>
HWY_INLINE const Index* vertices_of(const RestShapes& rest, Offset batch) {
  return rest.vertices.data() + batch * kBatch * (D + 1);
}

template <class Lanes>
HWY_INLINE LameLanes<Lanes> load_lame(const ElasticPass& pass, Offset batch, Index lane) {
  const Offset place = pass.lame_stride * batch + lane;
  return {Lanes::load(pass.mu + place), Lanes::load(pass.lambda + place)};
}

/// The numbers of the matrix's blocks to which a batch of a pass adds, and those of the next batch.
struct BatchBlocks {
  const Index* blocks = nullptr;
  const Index* next = nullptr;
  Index count = 0;  ///< number of simplices in the batch
  Index next_count = 0;
};

/// Returns the blocks of batch i in a pass over `batches` batches.
template <int D>
HWY_INLINE BatchBlocks blocks_of(const ElasticPass& pass, Offset i, Offset batches) {
  constexpr Offset kBlocks = kBatch * (D + 1) * (D + 1);
  BatchBlocks result;
  for (Offset k = i; k < std::min(i + 2, batches); ++k) {
    const Offset batch = pass.share ? pass.share->batches[k] : k;
    const Offset boundary = pass.share ? pass.share->boundary[k] : -1;
    (k == i ? result.blocks : result.next) =
        boundary < 0 ? pass.blocks + kBlocks * batch : pass.boundary_blocks + kBlocks * boundary;
    (k == i ? result.count : result.next_count) =
        static_cast<Index>(std::min<Offset>(kBatch, pass.rest.count - batch * kBatch));
  }
  return result;
}

/// Adds the forces of a batch of simplices to `targets` (the vertices of the batch, with spare vertices in
/// place of other threads' vertices) and its stiffness to the matrix's `blocks`.
///
/// A Law loads a deformation and its Lamé parameters; it computes stress(P) and energy(). A Tangent loads a
/// deformation, its law, parameters and a weight; it computes block(a, b, K) = weight · gₐ·∂P/∂F·g_b for two
/// of the corners 1 … D, numbered from 0, a ≤ b. Blocks with a = b are symmetric to the last bit.
template <int D, class Lanes, class Law, class Tangent>
HWY_INLINE void add_batch(const ElasticPass& pass, Offset batch, const Index* targets,
                          const BatchBlocks& blocks) {
  const double* const geometry = geometry_of<D>(pass.rest, batch);
  const Index* const vertices = vertices_of<D>(pass.rest, batch);
  constexpr bool kStiffness = !std::is_same_v<Tangent, NoTangent>;
  [[maybe_unused]] std::conditional_t<kStiffness, ElementBlocks<D>, NoTangent> element;
  for (Index lane = 0; lane < kBatch; lane += Lanes::kCount) {
    Deformation<D, Lanes> deformation;
    deformation.load(geometry + lane, vertices + lane, pass.positions);
    const LameLanes<Lanes> lame = load_lame<Lanes>(pass, batch, lane);
    Law law;
    law.load(deformation, lame);
    if (!kStiffness || pass.forces) {
      typename Lanes::Value stress[3][D];
      law.stress(deformation, lame, stress);
      deformation.add_forces(stress, targets + lane, pass.forces);
    }
    if constexpr (kStiffness) {
      Tangent tangent;
      tangent.load(deformation, law, lame, deformation.volume * Lanes::set(pass.scale));
      compute_blocks<D, Lanes>(tangent, lane, element);
    }
  }
  if constexpr (kStiffness) {
    constexpr Offset kBlocks = ElementBlocks<D>::kBlocks;
    for (Index lane = 0; lane < blocks.count; ++lane) {
      if (lane < blocks.next_count) ElementBlocks<D>::fetch(blocks.next + kBlocks * lane, pass.values);
      element.add(lane, blocks.blocks + kBlocks * lane, pass.values);
    }
  }
}

/// Computes all batches or the batches of a share; boundary batches of a share have their own targets and
/// blocks.
template <int D, class Lanes, class Law, class Tangent>
HWY_INLINE void add_batches(const ElasticPass& pass) {
  constexpr Offset kAhead = 8;  // batches between the one in use and the one prefetched
  const OwnedBatches* const share = pass.share;
  const Offset count = share ? static_cast<Offset>(share->batches.size()) : pass.rest.batches();
  for (Offset i = 0; i < count; ++i) {
    const Offset batch = share ? share->batches[i] : i;
    const Index* const vertices = vertices_of<D>(pass.rest, batch);
    fetch_stream<sizeof(Index) * kBatch*(D + 1)>(vertices_of<D>(pass.rest, batch + kAhead));
    fetch_stream<sizeof(double) * kBatch*(D * (D + 1) / 2 + 1)>(geometry_of<D>(pass.rest, batch + kAhead));
    BatchBlocks blocks;
    if constexpr (!std::is_same_v<Tangent, NoTangent>) blocks = blocks_of<D>(pass, i, count);
    add_batch<D, Lanes, Law, Tangent>(pass, batch, share ? share->targets_of(i, vertices, D + 1) : vertices,
                                      blocks);
  }
}

/// Returns Σ V Ψ of the batches begin … end − 1, in J if lengths are in m and moduli in Pa.
template <int D, class Lanes, class Law>
HWY_INLINE double energy_of_batches(const ElasticPass& pass, Index begin, Index end) {
  typename Lanes::Value sum = Lanes::set(0.0);
  for (Offset batch = begin; batch < end; ++batch) {
    for (Index lane = 0; lane < kBatch; lane += Lanes::kCount) {
      Deformation<D, Lanes> deformation;
      deformation.load(geometry_of<D>(pass.rest, batch) + lane, vertices_of<D>(pass.rest, batch) + lane,
                       pass.positions);
      const LameLanes<Lanes> lame = load_lame<Lanes>(pass, batch, lane);
      Law law;
      law.load(deformation, lame);
      sum = Lanes::mul_add(deformation.volume, law.energy(deformation, lame), sum);
    }
  }
  alignas(64) double lanes[Lanes::kCount];
  Lanes::store(sum, lanes);
  double total = 0.0;
  for (const double lane : lanes) total += lane;
  return total;
}

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
