// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <vector>

namespace meshorder::distributed {

/// The contents of a part's piece: the part's vertices and cells, and ghosts, which belong to other parts.
struct PieceContents {
  Index part = 0;
  /// New numbers of the vertices of the part, ascending; then those of the vertices of other parts that the
  /// cells use, ascending and therefore grouped by part.
  std::vector<GlobalIndex> vertices;
  GlobalIndex own_vertices = 0;
  /// New numbers of the cells of the part, ascending; then those of cells of other parts, sorted by part,
  /// then by number.
  std::vector<GlobalIndex> cells;
  GlobalIndex own_cells = 0;
  std::vector<Index> cell_parts;  ///< part of each cell
  Rows cell_vertices;             ///< vertices of each cell, as positions in `vertices`

  [[nodiscard]] GlobalIndex ghost_vertices() const { return std::ssize(vertices) - own_vertices; }
  [[nodiscard]] GlobalIndex ghost_cells() const { return std::ssize(cells) - own_cells; }
};

/// Returns the parts of each rank: ranges whose sizes differ by at most one.
[[nodiscard]] inline Layout ranks_of_parts(Index parts, int ranks) { return Layout::even(parts, ranks); }

/// Sends values to ranks. Returns the values that this rank receives, sorted by sending rank; values of one
/// rank keep their sequence.
template <class T, class RankOf>
std::vector<T> sent_to_ranks(const Communicator& communicator, const std::vector<T>& values,
                             const RankOf& rank_of) {
  return communicator
      .exchange(communicator.together([&] {
        return parcels_by_rank(
            values.size(), communicator.size(), [&](std::size_t k) { return rank_of(values[k]); },
            [&](std::size_t k) { return values[k]; });
      }))
      .values;
}

/// Finds the contents of the pieces of this rank's parts. A cell is in the part of its vertex with the
/// largest number, and is a ghost in the parts of its other vertices. Every rank has to call it. O(entries ·
/// log parts).
///
/// @param vertex_count   number of vertices of the whole mesh
/// @param cells          the owners of the cells' new numbers
/// @param cell_vertices  new numbers of the vertices of each cell of this rank, at least one
/// @param part_starts    first new number of each part, then the end of the last part
/// @param with_ghosts    whether a piece has the cells of other parts that use vertices of its part
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<PieceContents> contents_of_pieces(const Communicator& communicator,
                                                            GlobalIndex vertex_count, const Layout& cells,
                                                            const Rows& cell_vertices,
                                                            const std::vector<GlobalIndex>& part_starts,
                                                            bool with_ghosts);

}  // namespace meshorder::distributed
