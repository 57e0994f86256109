// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace meshorder {

/// Cells of one type, one after another.
struct CellPart {
  Index first = 0;
  Index count = 0;
  Shape shape = Shape::vertex;
  int nodes = 0;
  std::int64_t label = 0;
};

/// Labels of more kinds are no labels of blocks.
inline constexpr std::size_t kMostBlocks = 10000;

/// How cells are divided into blocks: by label, by sets where there are no labels, and by type.
struct CellDivision {
  bool by_labels = false;
  bool by_sets = false;
  std::vector<Index> key_of_cell;  ///< cells of one key are one block
  std::vector<CellPart> keys;      ///< in the order in which they appear; `first` is not used
};

/// What may divide cells into blocks, beside labels of 32 bits.
struct DividedBy {
  bool sets = false;         ///< where there are no labels
  bool wide_labels = false;  ///< labels of 64 bits
};

/// Returns the division of a mesh. O(cells · log blocks).
CellDivision divide_cells(const Mesh& mesh, DividedBy divided_by);

/// Returns the places of cells block by block, cells of the highest dimension first; `blocks` receives the
/// first cell of each. O(cells).
Permutation places_by_division(const CellDivision& division, std::vector<Index>& blocks);

}  // namespace meshorder
