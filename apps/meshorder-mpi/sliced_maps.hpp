// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "io/stream/output_set.hpp"
#include "maps.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::command {

/// Returns `checksums_of` a mesh that the ranks have slices of, on all of them. Every rank has to call it;
/// each waits for those before it. O(points + cells).
MeshChecksums checksums_of(const distributed::Communicator& communicator,
                           const distributed::MeshSlice& slice);

/// What maps are made of.
struct SlicedOrder {
  const std::vector<distributed::GlobalIndex>& new_vertices;  ///< new number of each vertex of the old slice
  const std::vector<distributed::GlobalIndex>& new_cells;     ///< new place of each of its cells
  const std::vector<distributed::GlobalIndex>& part_starts;   ///< as of `distributed::part_of`
  /// Number that the file gives to each vertex and cell of the old slice; null where these are their places.
  const std::vector<std::int64_t>* vertex_ids = nullptr;
  const std::vector<std::int64_t>* cell_ids = nullptr;
};

/// Writes the same files as `write_maps` by all ranks, each its range of every map, as files of a set. Every
/// rank has to call it. O(vertices + cells).
///
/// @param before   of the mesh in its old order
/// @param after    the mesh in its new order
/// @param outputs  the root's
/// @return the paths
/// @throws SharedError where a rank cannot write
std::vector<std::string> write_sliced_maps(const distributed::Communicator& communicator,
                                           const SlicedOrder& order, const MeshChecksums& before,
                                           const distributed::MeshSlice& after, const std::string& prefix,
                                           OutputSet& outputs);

}  // namespace meshorder::command
