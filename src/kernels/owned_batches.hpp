// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"
#include "kernels/simplices.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// The share of one thread in a kernel that adds to the vertices of elements or springs: a range of vertices
/// that it owns, and all batches that touch one of them. What a batch adds to vertices of others goes to
/// spare ones behind the mesh's, which nobody reads; their owners compute the batch as well. No two threads
/// then write to one place, without atomics or colours, and every sum has the terms of the serial kernel in
/// its order: the same bits for any number of threads. In a good order few batches are computed twice.
struct OwnedBatches {
  Index begin = 0;  ///< the vertices begin … end − 1 are owned
  Index end = 0;
  Index room = 0;              ///< vertices that the vector added to must hold, spare ones included
  std::vector<Index> batches;  ///< rising
  std::vector<Index>
      boundary;  ///< for each: −1 where all its vertices are owned, else its place in `targets`
  /// For each boundary batch what `vertices` has for it, with spare vertices in place of those not owned.
  AlignedVector<Index> targets;

  /// The vertices that batch `i` of `batches`, which has these `vertices`, adds to.
  [[nodiscard]] const Index* targets_of(Offset i, const Index* vertices, Index corners) const {
    return boundary[i] < 0 ? vertices : targets.data() + Offset{boundary[i]} * corners * kBatch;
  }
};

/// The bounds, parts + 1 of them, of contiguous ranges of the rows of a matrix with about as many entries
/// each. `offsets` are those of compressed rows. O(parts · log rows).
std::vector<Index> balanced_ranges(std::span<const Offset> offsets, Index parts);

/// One share for each range of `bounds` (see balanced_ranges), the last bound being the number of vertices,
/// of the batches of `corners` · kBatch vertices each: RestShapes::vertices with D + 1 corners, Springs::ends
/// with
/// 2. Each has its own spare vertices behind those of the mesh. O(entries · log parts).
std::vector<OwnedBatches> owned_batches(std::span<const Index> vertices, Index corners,
                                        std::span<const Index> bounds);

/// Throws InvalidArgument, naming `function`, unless the forces (see padded_positions) have room for the
/// share.
void check_room(std::span<const double> forces, const OwnedBatches& share, const char* function);

}  // namespace meshorder
