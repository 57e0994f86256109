// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/block_csr.hpp"
#include "kernels/owned_batches.hpp"

namespace meshorder {

/// The positions of each simplex's blocks in a matrix: block (a, b) of simplex s, which couples its corners a
/// and b, is block `blocks[(D + 1)² s + (D + 1) a + b]` of the matrix. A tetrahedron takes one cache line.
struct AssemblyMap {
  int dimension = 0;
  AlignedVector<Index> blocks;
};

/// Returns the map of the simplices into the pattern of a matrix. Throws InvalidArgument if the pattern lacks
/// a block or has more blocks than kMaxIndex. On all threads. O(simplices · log row length).
AssemblyMap assembly_map(const RestShapes& rest, const BlockCsr& matrix);

/// The map of one share of `owned_batches` (of rest.vertices). It has the blocks of the share's boundary
/// batches, batch after batch; spare blocks replace blocks in rows that the share does not own.
struct OwnedBlocks {
  AlignedVector<Index> blocks;
  Offset room = 0;  ///< number of blocks that the matrix must hold, including spare blocks
};

/// Returns the map of share number `part`. Its spare blocks come after the matrix's blocks and the spare
/// blocks of shares with smaller numbers. Throws InvalidArgument if a block's number does not fit an Index.
/// O(boundary simplices).
OwnedBlocks owned_blocks(const RestShapes& rest, const AssemblyMap& map, const BlockCsr& matrix,
                         const OwnedBatches& share, Index part);

}  // namespace meshorder
