// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/assembly.hpp"

#include <meshorder/error.hpp>

#include <string>

namespace meshorder {

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
    for (int a = 0; a <= d; ++a) {
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
  // the largest number of blocks of a simplex, on separate cache lines
  constexpr Offset kSpareBlocks = 16 + 2;
  const Index corners = rest.dimension + 1;
  const Offset first_spare = matrix.block_count() + 2 + kSpareBlocks * part;
  OwnedBlocks result;
  result.room = first_spare + kSpareBlocks;
  if (result.room > kMaxIndex) {
    throw InvalidArgument("assembly: " + std::to_string(result.room) +
                          " blocks, including spare ones; at most 2,147,483,647 can be numbered");
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

}  // namespace meshorder
