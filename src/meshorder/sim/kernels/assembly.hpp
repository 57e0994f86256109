// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/sim/kernels/block_csr.hpp>
#include <meshorder/sim/kernels/element_force.hpp>

#include <span>

namespace meshorder {

/// Where the blocks of each simplex stand in a matrix: block (a, b) of simplex s, which couples its corners a
/// and b, is block `blocks[(D + 1)² s + (D + 1) a + b]`; one cache line for a tetrahedron.
struct AssemblyMap {
  int dimension = 0;
  AlignedVector<Index> blocks;
};

/// The map of the simplices into a matrix of that pattern. Throws InvalidArgument when the pattern lacks a
/// block. O(simplices · log row length).
AssemblyMap assembly_map(const RestShapes& rest, const BlockCsr& matrix);

/// The map of one share of `owned_batches` (of rest.vertices): for its boundary batches, in their order, the
/// blocks of the map, with spare blocks in place of those in rows that are not owned.
struct OwnedBlocks {
  AlignedVector<Index> blocks;
  Offset room = 0;  ///< blocks that the matrix's values must hold, spare ones included
};

/// The map of share number `part`, whose spare blocks stand behind the matrix's and those of the shares
/// before it. Throws InvalidArgument when they cannot be numbered. O(boundary simplices).
OwnedBlocks owned_blocks(const RestShapes& rest, const AssemblyMap& map, const BlockCsr& matrix,
                         const OwnedBatches& share, Index part);

/// matrix += K = ∂²E/∂x², the exact Hessian of stvk_energy (symmetric; indefinite under compression).
/// `positions` has the layout of padded_positions. O(simplices).
///
/// With g_a the shape gradients at rest, p_a = F g_a and S the stress, the block of the corners a and b is
/// K_ab = V ((g_a·S g_b) I + λ p_a p_bᵀ + μ p_b p_aᵀ + μ (g_a·g_b) F Fᵀ): the strain's variation in δx_b is
/// that of δF = δx_b g_bᵀ. Its parts are computed for a batch of simplices at a time, its sums for the nine
/// entries of a block at a time.
void add_stvk_stiffness(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                        const AssemblyMap& map, BlockCsr& matrix);

/// The rows of that sum that one share owns, for threads to share the work; over all shares the same bits.
/// Throws InvalidArgument when the matrix has no room for the spare blocks.
void add_stvk_stiffness(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                        const AssemblyMap& map, const OwnedBatches& share, const OwnedBlocks& boundary,
                        BlockCsr& matrix);

}  // namespace meshorder
