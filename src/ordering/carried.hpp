// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include <meshorder/number_view.hpp>

#include <span>
#include <vector>

namespace meshorder {

/// The vertices of an update beside those of the last one.
struct VertexChanges {
  std::vector<Index>
      places;  ///< of each vertex after the last update, −1 for new ones; empty: nothing changed
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

/// Returns the vertices in the order that they had, new ones next to their neighbours: the first one after
/// the median of those that were there, from neighbour to neighbour breadth first, those that reach none
/// last.
///
/// @param places  for each vertex its place in the old order, of which none comes twice, −1 for a new one
/// @param count   number of places in the old order
/// @param added   the new vertices, ascending
/// @param rows    a row for each of them
/// @note O(vertices + count + entries of the rows · log), on one thread.
std::vector<Index> carried_order(std::span<const Index> places, Index count, std::span<const Index> added,
                                 const NeighbourRows& rows);

}  // namespace meshorder
