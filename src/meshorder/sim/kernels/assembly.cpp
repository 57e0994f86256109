// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/kernels/assembly.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "meshorder/sim/kernels/assembly.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include <meshorder/sim/kernels/stvk-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// What the blocks of a batch are summed of, each for every lane. Pair (a, b), a ≤ b, is number
/// `pair_number<D>(a, b)`.
template <int D>
struct BatchTerms {
  static constexpr int kPairs = (D + 1) * (D + 2) / 2;
  alignas(64) double p[D + 1][3][kBatch];        ///< F g_a
  alignas(64) double volume[kBatch];             ///< V
  alignas(64) double fft[6][kBatch];             ///< F Fᵀ: 00 01 02 11 12 22
  alignas(64) double geometric[kPairs][kBatch];  ///< V g_a·S g_b
  alignas(64) double material[kPairs][kBatch];   ///< V μ g_a·g_b
};

template <int D>
constexpr int pair_number(int a, int b) {
  return a * (D + 1) - a * (a - 1) / 2 + b - a;
}

template <int D, class Lanes>
HWY_INLINE void compute_terms(const OldStvk<D, Lanes>& stvk, const Lame& lame, Index lane,
                              BatchTerms<D>& terms) {
  using Value = typename Lanes::Value;
  // shape gradients; g₀ is minus the sum of the others
  Value g[D + 1][D];
  MESHORDER_UNROLL
  for (int j = 0; j < D; ++j) {
    Value sum = Lanes::set(0.0);
    MESHORDER_UNROLL
    for (int a = 0; a < D; ++a) {
      g[a + 1][j] = a <= j ? stvk.inverse[a][j] : Lanes::set(0.0);
      sum = sum - g[a + 1][j];
    }
    g[0][j] = sum;
  }
  MESHORDER_UNROLL
  for (int a = 0; a <= D; ++a) {
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      Value p = stvk.f[c][0] * g[a][0];
      MESHORDER_UNROLL
      for (int j = 1; j < D; ++j) p = Lanes::mul_add(stvk.f[c][j], g[a][j], p);
      Lanes::store(p, terms.p[a][c] + lane);
    }
  }
  Lanes::store(stvk.volume, terms.volume + lane);
  int entry = 0;
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    MESHORDER_UNROLL
    for (int j = i; j < 3; ++j) {
      Value sum = stvk.f[i][0] * stvk.f[j][0];
      MESHORDER_UNROLL
      for (int k = 1; k < D; ++k) sum = Lanes::mul_add(stvk.f[i][k], stvk.f[j][k], sum);
      Lanes::store(sum, terms.fft[entry++] + lane);
    }
  }
  const Value volume_mu = stvk.volume * Lanes::set(lame.mu);
  MESHORDER_UNROLL
  for (int a = 0; a <= D; ++a) {
    Value sg[D];
    MESHORDER_UNROLL
    for (int j = 0; j < D; ++j) {
      sg[j] = stvk.s[j][0] * g[a][0];
      MESHORDER_UNROLL
      for (int k = 1; k < D; ++k) sg[j] = Lanes::mul_add(stvk.s[j][k], g[a][k], sg[j]);
    }
    MESHORDER_UNROLL
    for (int b = a; b <= D; ++b) {
      Value geometric = sg[0] * g[b][0];
      Value material = g[a][0] * g[b][0];
      MESHORDER_UNROLL
      for (int j = 1; j < D; ++j) {
        geometric = Lanes::mul_add(sg[j], g[b][j], geometric);
        material = Lanes::mul_add(g[a][j], g[b][j], material);
      }
      Lanes::store(stvk.volume * geometric, terms.geometric[pair_number<D>(a, b)] + lane);
      Lanes::store(volume_mu * material, terms.material[pair_number<D>(a, b)] + lane);
    }
  }
}

/// Adds the blocks of one lane. The first eight entries of a block are taken as vectors: entry 3i + j of
/// p_a p_bᵀ is "rows of a" · "columns of b".
template <int D>
HWY_INLINE void add_blocks(const BatchTerms<D>& terms, const Lame& lame, Index lane, const Index* blocks,
                           double* values) {
  alignas(64) double rows[D + 1][8];
  alignas(64) double lambda_columns[D + 1][8];
  alignas(64) double mu_columns[D + 1][8];
  alignas(64) double fft[8];
  alignas(64) constexpr double kIdentity[8] = {1, 0, 0, 0, 1, 0, 0, 0};
  const double volume_lambda = terms.volume[lane] * lame.lambda;
  const double volume_mu = terms.volume[lane] * lame.mu;
  MESHORDER_UNROLL
  for (int a = 0; a <= D; ++a) {
    MESHORDER_UNROLL
    for (int k = 0; k < 8; ++k) {
      rows[a][k] = terms.p[a][k / 3][lane];
      lambda_columns[a][k] = volume_lambda * terms.p[a][k % 3][lane];
      mu_columns[a][k] = volume_mu * terms.p[a][k % 3][lane];
    }
  }
  constexpr int kSymmetric[8] = {0, 1, 2, 1, 3, 4, 2, 4};
  MESHORDER_UNROLL
  for (int k = 0; k < 8; ++k) fft[k] = terms.fft[kSymmetric[k]][lane];

  using Tag = hn::CappedTag<double, 8>;
  const Tag d;
  for (Index k = 0; k < 8; k += static_cast<Index>(MaxLanes(d))) {
    const auto identity = hn::Load(d, kIdentity + k);
    const auto outer = hn::Load(d, fft + k);
    MESHORDER_UNROLL
    for (int a = 0; a <= D; ++a) {
      MESHORDER_UNROLL
      for (int b = a; b <= D; ++b) {
        const int pair = pair_number<D>(a, b);
        const auto shared = hn::MulAdd(hn::Set(d, terms.material[pair][lane]), outer,
                                       hn::Set(d, terms.geometric[pair][lane]) * identity);
        double* const ab = values + Offset{9} * blocks[a * (D + 1) + b] + k;
        const auto upper = hn::MulAdd(hn::Load(d, rows[a] + k), hn::Load(d, lambda_columns[b] + k), shared);
        hn::StoreU(
            hn::LoadU(d, ab) + hn::MulAdd(hn::Load(d, rows[b] + k), hn::Load(d, mu_columns[a] + k), upper), d,
            ab);
        if (a == b) continue;
        double* const ba = values + Offset{9} * blocks[b * (D + 1) + a] + k;
        const auto lower = hn::MulAdd(hn::Load(d, rows[b] + k), hn::Load(d, lambda_columns[a] + k), shared);
        hn::StoreU(
            hn::LoadU(d, ba) + hn::MulAdd(hn::Load(d, rows[a] + k), hn::Load(d, mu_columns[b] + k), lower), d,
            ba);
      }
    }
  }
  MESHORDER_UNROLL
  for (int a = 0; a <= D; ++a) {
    MESHORDER_UNROLL
    for (int b = a; b <= D; ++b) {
      const int pair = pair_number<D>(a, b);
      const double last = (lambda_columns[a][2] + mu_columns[a][2]) * terms.p[b][2][lane] +
                          terms.material[pair][lane] * terms.fft[5][lane] + terms.geometric[pair][lane];
      values[Offset{9} * blocks[a * (D + 1) + b] + 8] += last;
      if (a != b) values[Offset{9} * blocks[b * (D + 1) + a] + 8] += last;
    }
  }
}

/// Adds a batch of simplices to their blocks.
template <int D>
HWY_INLINE void add_batch(const RestShapes& rest, Offset batch, const Lame& lame, const double* positions,
                          const Index* blocks, double* values) {
  const double* const geometry = rest.geometry.data() + batch * kBatch * (D * (D + 1) / 2 + 1);
  const Index* const vertices = rest.vertices.data() + batch * kBatch * (D + 1);
  BatchTerms<D> terms;
  for (Index lane = 0; lane < kBatch; lane += ManyLanes::kCount) {
    OldStvk<D, ManyLanes> stvk;
    stvk.load(geometry + lane, vertices + lane, positions);
    stvk.strain_and_stress(lame);
    compute_terms(stvk, lame, lane, terms);
  }
  const auto lanes = static_cast<Index>(std::min<Offset>(kBatch, rest.count - batch * kBatch));
  for (Index lane = 0; lane < lanes; ++lane) {
    add_blocks<D>(terms, lame, lane, blocks, values);
    blocks += (D + 1) * (D + 1);
  }
}

/// All batches, or those of a share, whose boundary batches have blocks of their own.
template <int D>
HWY_INLINE void add_stiffness(const RestShapes& rest, const Lame& lame, const double* positions,
                              const Index* blocks, double* values, const OwnedBatches* share,
                              const Index* boundary_blocks) {
  constexpr Offset kBlocks = kBatch * (D + 1) * (D + 1);
  const Offset count = share ? static_cast<Offset>(share->batches.size()) : rest.batches();
  for (Offset i = 0; i < count; ++i) {
    const Offset batch = share ? share->batches[i] : i;
    const Offset boundary = share ? share->boundary[i] : -1;
    add_batch<D>(rest, batch, lame, positions,
                 boundary < 0 ? blocks + kBlocks * batch : boundary_blocks + kBlocks * boundary, values);
  }
}

void add_stiffness_of_any(const RestShapes& rest, const Lame& lame, const double* positions,
                          const Index* blocks, double* values, const OwnedBatches* share,
                          const Index* boundary_blocks) {
  if (rest.dimension == 3) add_stiffness<3>(rest, lame, positions, blocks, values, share, boundary_blocks);
  if (rest.dimension == 2) add_stiffness<2>(rest, lame, positions, blocks, values, share, boundary_blocks);
  if (rest.dimension == 1) add_stiffness<1>(rest, lame, positions, blocks, values, share, boundary_blocks);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <meshorder/base/error.hpp>

#include <string>

namespace meshorder {
namespace {

HWY_EXPORT(add_stiffness_of_any);

}  // namespace

AssemblyMap assembly_map(const RestShapes& rest, const BlockCsr& matrix) {
  if (matrix.block_count() > kMaxIndex) {
    throw InvalidArgument("assembly: a matrix of " + std::to_string(matrix.block_count()) +
                          " blocks; at most 2,147,483,647 can be numbered");
  }
  const int d = rest.dimension;
  AssemblyMap map;
  map.dimension = d;
  map.blocks.reserve(rest.count * (d + 1) * (d + 1));
  for (Offset s = 0; s < rest.count; ++s) {
    const Index* const corner = rest.vertices.data() + s / kBatch * kBatch * (d + 1) + s % kBatch;
    MESHORDER_UNROLL
    for (int a = 0; a <= d; ++a) {
      MESHORDER_UNROLL
      for (int b = 0; b <= d; ++b) {
        const Offset block = matrix.find(corner[a * kBatch], corner[b * kBatch]);
        if (block < 0) {
          throw InvalidArgument("assembly: the matrix has no block for the vertices " +
                                std::to_string(corner[a * kBatch]) + " and " +
                                std::to_string(corner[b * kBatch]) + " of an element");
        }
        map.blocks.push_back(static_cast<Index>(block));
      }
    }
  }
  return map;
}

OwnedBlocks owned_blocks(const RestShapes& rest, const AssemblyMap& map, const BlockCsr& matrix,
                         const OwnedBatches& share, Index part) {
  // the most that a simplex has, on cache lines of their own
  constexpr Offset kSpareBlocks = 16 + 2;
  const Index corners = rest.dimension + 1;
  const Offset first_spare = matrix.block_count() + 2 + kSpareBlocks * part;
  OwnedBlocks result;
  result.room = first_spare + kSpareBlocks;
  if (result.room > kMaxIndex) {
    throw InvalidArgument("assembly: " + std::to_string(result.room) +
                          " blocks, spare ones included; at most 2,147,483,647 can be numbered");
  }
  for (std::size_t i = 0; i < share.batches.size(); ++i) {
    if (share.boundary[i] < 0) continue;
    const Offset batch = share.batches[i];
    for (Index lane = 0; lane < kBatch; ++lane) {
      const Offset simplex = batch * kBatch + lane;
      for (Index pair = 0; pair < corners * corners; ++pair) {
        const Index row = rest.vertices[(batch * corners + pair / corners) * kBatch + lane];
        const bool owned = simplex < rest.count && row >= share.begin && row < share.end;
        result.blocks.push_back(owned ? map.blocks[corners * corners * simplex + pair]
                                      : static_cast<Index>(first_spare) + pair);
      }
    }
  }
  return result;
}

namespace {

void check_map(const RestShapes& rest, const AssemblyMap& map) {
  if (static_cast<Offset>(map.blocks.size()) != rest.count * (rest.dimension + 1) * (rest.dimension + 1)) {
    throw InvalidArgument("add_stvk_stiffness: the map belongs to other simplices");
  }
}

}  // namespace

void add_stvk_stiffness(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                        const AssemblyMap& map, BlockCsr& matrix) {
  check_map(rest, map);
  HWY_DYNAMIC_DISPATCH(add_stiffness_of_any)
  (rest, lame, positions.data(), map.blocks.data(), matrix.values.data(), nullptr, nullptr);
}

void add_stvk_stiffness(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                        const AssemblyMap& map, const OwnedBatches& share, const OwnedBlocks& boundary,
                        BlockCsr& matrix) {
  check_map(rest, map);
  if (static_cast<Offset>(matrix.values.size()) < 9 * boundary.room) {
    throw InvalidArgument("add_stvk_stiffness: the matrix has no room for the spare blocks");
  }
  HWY_DYNAMIC_DISPATCH(add_stiffness_of_any)
  (rest, lame, positions.data(), map.blocks.data(), matrix.values.data(), &share, boundary.blocks.data());
}

}  // namespace meshorder
#endif
