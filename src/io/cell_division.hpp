// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace meshorder {

/// A block: cells of one type and one label or set, which follow one another in a file.
struct CellPart {
  Index first = 0;  ///< first cell
  Index count = 0;  ///< number of cells
  Shape shape = Shape::vertex;
  int nodes = 0;
  std::int64_t label = 0;  ///< label, or number of a set; 0 if there is neither
};

/// Maximum number of blocks. If labels or sets would give more blocks, cells are divided by type alone.
inline constexpr std::size_t kMostBlocks = 10000;

/// A division of cells into blocks: by label and type, by set and type, or by type alone.
struct CellDivision {
  bool by_labels = false;
  bool by_sets = false;
  std::vector<Index> key_of_cell;  ///< index in `keys` of each cell's block
  std::vector<CellPart> keys;      ///< the blocks, ascending by `first`
};

/// Options of `divide_cells`: what divides the cells besides types and 32-bit labels.
struct DividedBy {
  bool sets = false;         ///< sets of cells, if there are no labels to use
  bool wide_labels = false;  ///< labels of 64 bits
};

/// Returns the division of a mesh. O(cells · log blocks).
CellDivision divide_cells(const Mesh& mesh, DividedBy divided_by);

/// Returns the permutation of cells that makes each block contiguous; blocks of higher dimension come first.
/// `blocks` receives the new position of each block's first cell. O(cells).
Permutation places_by_division(const CellDivision& division, std::vector<Index>& blocks);

}  // namespace meshorder
