// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/moved_part.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder::distributed {

/// The new numbers that the vertices and cells of a rank have in the whole mesh.
struct ShareNumbers {
  Layout layout;                      ///< the owners of the vertices of the whole mesh, for exchanges
  std::vector<GlobalIndex> vertices;  ///< ascending
  std::vector<GlobalIndex> cells;     ///< ascending

  /// Returns the numbers on a rank that has the whole mesh.
  [[nodiscard]] static ShareNumbers of_whole(const Mesh& mesh);
};

/// A rank's share of a mesh that is written in pieces: the cells of the rank's parts, the vertices of these
/// cells, the unused vertices of these parts, and the arrays, sets and ids of all these.
struct MeshShare {
  /// Vertices and cells are in the order of their numbers. All sets are kept, even without members. An array
  /// on only some vertices or cells is dropped if it has no rows in the share. Rows and members keep the
  /// file's order.
  Mesh mesh;
  ShareNumbers numbers;
  bool has_vertex_ids = false;  ///< whether any rank has vertex ids
  bool has_cell_ids = false;
};

/// Returns the share of this rank; its parts are those of `ranks_of_parts`. A cell is in the part of its
/// vertex with the largest number. Every rank has to call it. O(size of the part + size of the share · log).
///
/// @param part_starts  as in `part_of`
/// @throws as `Communicator::exchange`
[[nodiscard]] MeshShare share_of(const Communicator& communicator, const MovedPart& moved,
                                 const std::vector<GlobalIndex>& part_starts);

}  // namespace meshorder::distributed
