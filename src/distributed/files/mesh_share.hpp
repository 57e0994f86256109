// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/moved_part.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder::distributed {

/// The numbers, in the whole mesh in its new order, of the vertices and cells that a rank has.
struct ShareNumbers {
  Layout layout;                      ///< who answers for which vertices of the whole mesh
  std::vector<GlobalIndex> vertices;  ///< ascending
  std::vector<GlobalIndex> cells;     ///< ascending

  /// Returns those of a mesh that one rank has as a whole.
  [[nodiscard]] static ShareNumbers of_whole(const Mesh& mesh);
};

/// What a rank has of a mesh that is written in pieces: the cells of its parts, their vertices, and the
/// vertices of these parts that no cell uses, with all that belongs to them.
struct MeshShare {
  /// In the order of their numbers. Sets have all their names, perhaps without members; arrays on some
  /// vertices or cells are there where they have rows. The order of rows and members is that of the file.
  Mesh mesh;
  ShareNumbers numbers;
  bool has_vertex_ids = false;  ///< on any rank
  bool has_cell_ids = false;
};

/// Returns the share of this rank, whose parts are those of `ranks_of_parts`. A cell is in the part of its
/// last vertex. Every rank has to call it. O(size of the part + size of the share · log).
///
/// @param part_starts  as of `part_of`
/// @throws as `Communicator::exchange`
[[nodiscard]] MeshShare share_of(const Communicator& communicator, const MovedPart& moved,
                                 const std::vector<GlobalIndex>& part_starts);

}  // namespace meshorder::distributed
