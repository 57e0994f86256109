// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/block_csr.hpp"
#include "kernels/owned_batches.hpp"

namespace meshorder {

/// The positions of each simplex's blocks in a matrix: block (a, b) of simplex s, which couples its corners a
/// and b, is block `blocks[(D + 1)² s + (D + 1) a + b]`; one cache line for a tetrahedron.
struct AssemblyMap {
  int dimension = 0;
  AlignedVector<Index> blocks;
};

/// Returns the map of the simplices into a matrix of that pattern. Throws InvalidArgument if the pattern
/// lacks a block. On all threads. O(simplices · log row length).
AssemblyMap assembly_map(const RestShapes& rest, const BlockCsr& matrix);

/// The map of one share of `owned_batches` (of rest.vertices): for its boundary batches, in their order, the
/// blocks of the map, with spare blocks in place of those in rows that are not owned.
struct OwnedBlocks {
  AlignedVector<Index> blocks;
  Offset room = 0;  ///< blocks that the matrix's values must hold, including spare ones
};

/// The map of share number `part`, whose spare blocks follow the matrix's and those of the shares
/// before it. Throws InvalidArgument if their numbers exceed an Index. O(boundary simplices).
OwnedBlocks owned_blocks(const RestShapes& rest, const AssemblyMap& map, const BlockCsr& matrix,
                         const OwnedBatches& share, Index part);

}  // namespace meshorder
