// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/assembly.hpp"

#include "base/parallel.hpp"
#include "graph/row_access.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <atomic>
#include <span>
#include <string>

namespace meshorder {

AssemblyMap assembly_map(const RestShapes& rest, const BlockCsr& matrix) {
  if (matrix.block_count() > kMaxIndex) {
    throw InvalidArgument("assembly: a matrix of " + std::to_string(matrix.block_count()) +
                          " blocks; at most 2,147,483,647 can be numbered");
  }
  const int corners = rest.dimension + 1;
  AssemblyMap map;
  map.dimension = rest.dimension;
  map.blocks.resize(rest.count * corners * corners);
  const auto corners_of = [&](Offset batch) {
    const Offset first = std::min(batch, rest.batches() - 1) * corners * kBatch;
    return std::span<const Index>(rest.vertices).subspan(first, Offset{corners} * kBatch);
  };
  std::atomic<bool> complete = true;
  constexpr Offset kSimplices = 4096;
  for_each_range(rest.count, kSimplices, [&](Offset begin, Offset end) {
    Index* block = map.blocks.data() + begin * corners * corners;
    Offset least = 0;
    for (Offset s = begin; s < end; ++s) {
      if (s % kBatch == 0) {
        prefetch_offsets(matrix.offsets, corners_of(s / kBatch + 2));
        prefetch_rows(matrix.offsets, matrix.columns, corners_of(s / kBatch + 1));
      }
      const Index* const corner = rest.vertices.data() + s / kBatch * kBatch * corners + s % kBatch;
      for (int a = 0; a < corners; ++a) {
        for (int b = 0; b < corners; ++b) {
          const Offset found = matrix.find(corner[a * kBatch], corner[b * kBatch]);
          least = std::min(least, found);
          *block++ = static_cast<Index>(found);
        }
      }
    }
    if (least < 0) complete = false;
  });
  if (!complete) {
    // reports the first missing block, for any number of threads
    const Offset place = std::find(map.blocks.begin(), map.blocks.end(), -1) - map.blocks.begin();
    const Offset pair = place % (corners * corners);
    const Offset s = place / (corners * corners);
    throw InvalidArgument("assembly: the matrix has no block for the vertices " +
                          std::to_string(rest.vertex(s, static_cast<Index>(pair / corners))) + " and " +
                          std::to_string(rest.vertex(s, static_cast<Index>(pair % corners))) +
                          " of an element");
  }
  return map;
}

OwnedBlocks owned_blocks(const RestShapes& rest, const AssemblyMap& map, const BlockCsr& matrix,
                         const OwnedBatches& share, Index part) {
  // a simplex has at most 16 blocks; 2 more blocks keep the shares on separate cache lines
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
