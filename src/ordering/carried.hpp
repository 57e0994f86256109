// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include <meshorder/number_view.hpp>

#include <span>
#include <vector>

namespace meshorder {

/// How the vertices of an update differ from those of the previous update.
struct VertexChanges {
  std::vector<Index> places;  ///< each vertex's place after the previous update, −1 if new; empty: none moved
  std::vector<Index> added;
  Index removed = 0;
};

/// Returns what changed. Throws InvalidArgument unless `previous` fits: see `Reorderer::update`. O(vertices).
///
/// @param size   number of vertices now
/// @param count  number of vertices after the last update
VertexChanges changes_of(const IndexView& previous, Index size, Index count);

/// The neighbours of some vertices, row after row; repeats are allowed.
struct NeighbourRows {
  std::vector<Offset> offsets{0};
  std::vector<Index> neighbours;
};

/// Returns the vertices in their old order, with new ones next to their neighbours: each comes after the
/// median of its neighbours that have a place. New vertices are placed in waves, from neighbour to neighbour;
/// vertices from which no placed vertex can be reached come last.
///
/// @param places  each vertex's place in the old order, −1 for a new vertex; no place occurs twice
/// @param count   number of places in the old order
/// @param added   the new vertices, ascending
/// @param rows    a row for each new vertex
/// @note O(vertices + count + entries of the rows · log), on one thread.
std::vector<Index> carried_order(std::span<const Index> places, Index count, std::span<const Index> added,
                                 const NeighbourRows& rows);

}  // namespace meshorder
