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

/// matrix += K = ∂²E/∂x², the exact Hessian of stvk_energy (symmetric; indefinite under compression).
/// `positions` has the layout of padded_positions. O(simplices).
///
/// With g_a the shape gradients at rest, p_a = F g_a and S the stress, the block of the corners a and b is
/// K_ab = V ((g_a·S g_b) I + λ p_a p_bᵀ + μ p_b p_aᵀ + μ (g_a·g_b) F Fᵀ): the strain's variation in δx_b is
/// that of δF = δx_b g_bᵀ. Its parts are computed for a batch of simplices at a time, its sums for the nine
/// entries of a block at a time.
void add_stvk_stiffness(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                        const AssemblyMap& map, BlockCsr& matrix);

}  // namespace meshorder
