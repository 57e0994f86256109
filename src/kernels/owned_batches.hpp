// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"
#include "kernels/simplices.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// One thread's share of a kernel that adds to the vertices of elements or springs: a range of vertices that
/// it owns, and all batches that touch a vertex of the range. Contributions to vertices that other threads
/// own go to spare vertices, which come after the mesh's vertices. The sums at spare vertices are not used,
/// because the owners compute these batches as well. So no two threads write to the same address, without
/// atomics or colouring. Every sum has the terms of the serial kernel in the same sequence, so the bits are
/// the same for any number of threads. In a good order few batches are computed twice.
struct OwnedBatches {
  Index begin = 0;  ///< the vertices begin … end − 1 are owned
  Index end = 0;
  Index room = 0;              ///< number of vertices that the forces must hold, including spare vertices
  std::vector<Index> batches;  ///< ascending
  std::vector<Index>
      boundary;  ///< for each batch: −1 if all its vertices are owned, else its number among boundary batches
  /// The vertices of each boundary batch, with spare vertices in place of vertices that are not owned.
  AlignedVector<Index> targets;

  /// Returns the vertices to which batch `i` of `batches` adds; `vertices` are the corners of that batch.
  [[nodiscard]] const Index* targets_of(Offset i, const Index* vertices, Index corners) const {
    return boundary[i] < 0 ? vertices : targets.data() + Offset{boundary[i]} * corners * kBatch;
  }
};

/// Returns the parts + 1 bounds of contiguous ranges of rows with about equal numbers of entries. `offsets`
/// are the offsets of the compressed rows. O(parts · log rows).
std::vector<Index> balanced_ranges(std::span<const Offset> offsets, Index parts);

/// Sets `owners` to the ascending numbers of the ranges in `bounds` that hold any of `vertices`. O(vertices ·
/// log parts).
void owners_of(std::span<const Index> vertices, std::span<const Index> bounds, std::vector<Index>& owners);

/// Returns one share for each range of `bounds` (see balanced_ranges); the last bound is the number of
/// vertices. `vertices` has batches of `corners` · kBatch vertices each: RestShapes::vertices with D + 1
/// corners, or Springs::ends with 2. Each share has its own spare vertices after those of the mesh.
/// O(entries · log parts).
std::vector<OwnedBatches> owned_batches(std::span<const Index> vertices, Index corners,
                                        std::span<const Index> bounds);

/// Throws InvalidArgument, naming `function`, unless the forces (see padded_positions) have room for the
/// share.
void check_room(std::span<const double> forces, const OwnedBatches& share, const char* function);

}  // namespace meshorder
