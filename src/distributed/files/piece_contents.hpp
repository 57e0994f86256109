// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <vector>

namespace meshorder::distributed {

/// What the piece of a part holds: the part's vertices and cells, and ghosts, those of other parts.
struct PieceContents {
  Index part = 0;
  /// New numbers: the own ones, ascending, then those that the cells use of other parts, ascending, by which
  /// those of a part follow each other.
  std::vector<GlobalIndex> vertices;
  GlobalIndex own_vertices = 0;
  /// New numbers: the own ones, ascending, then those of other parts, by the part and then ascending.
  std::vector<GlobalIndex> cells;
  GlobalIndex own_cells = 0;
  std::vector<Index> cell_parts;  ///< of each cell
  Rows cell_vertices;             ///< of each cell, as places among `vertices`

  [[nodiscard]] GlobalIndex ghost_vertices() const { return std::ssize(vertices) - own_vertices; }
  [[nodiscard]] GlobalIndex ghost_cells() const { return std::ssize(cells) - own_cells; }
};

/// Returns which ranks have which parts: as equal numbers as can be, in ranges.
[[nodiscard]] inline Layout ranks_of_parts(Index parts, int ranks) { return Layout::even(parts, ranks); }

/// Finds what the pieces of this rank's parts hold. A cell is in the part of its last vertex, and a ghost in
/// those of its other vertices. Every rank has to call it. O(entries · log parts).
///
/// @param vertex_count   of the whole mesh
/// @param cells          who has which cells, by new numbers
/// @param cell_vertices  of the own ones, by new numbers; each has one at least
/// @param part_starts    first new number of each part, and the end of the last one's
/// @param with_ghosts    whether a piece has the cells of other parts that use vertices of its part
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<PieceContents> contents_of_pieces(const Communicator& communicator,
                                                            GlobalIndex vertex_count, const Layout& cells,
                                                            const Rows& cell_vertices,
                                                            const std::vector<GlobalIndex>& part_starts,
                                                            bool with_ghosts);

}  // namespace meshorder::distributed
