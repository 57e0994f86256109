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

/// Returns the checksums of a distributed mesh on all ranks. Every rank has to call it; each waits for the
/// ranks before it. O(points + cells).
MeshChecksums checksums_of(const distributed::Communicator& communicator,
                           const distributed::MeshSlice& slice);

/// The data that maps are made of.
struct SlicedOrder {
  const std::vector<distributed::GlobalIndex>& new_vertices;  ///< new number of each vertex of the old slice
  const std::vector<distributed::GlobalIndex>& new_cells;     ///< new number of each cell of the old slice
  const std::vector<distributed::GlobalIndex>& part_starts;   ///< as in `distributed::part_of`
  /// Numbers that the file gives the vertices and cells of the old slice; null if these are their positions.
  const std::vector<std::int64_t>* vertex_ids = nullptr;
  const std::vector<std::int64_t>* cell_ids = nullptr;
};

/// Writes the same files as `write_maps`, as files of a set; each rank writes its range of every map. Every
/// rank has to call it. O(vertices + cells).
///
/// @param before   checksums of the mesh in its old order
/// @param after    the mesh in its new order
/// @param outputs  used at the root
/// @return the paths
/// @throws SharedError if a rank cannot write
std::vector<std::string> write_sliced_maps(const distributed::Communicator& communicator,
                                           const SlicedOrder& order, const MeshChecksums& before,
                                           const distributed::MeshSlice& after, const std::string& prefix,
                                           OutputSet& outputs);

}  // namespace meshorder::command
