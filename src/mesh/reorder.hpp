// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"
#include "ordering/permutation.hpp"

namespace meshorder {

/// Moves the vertices and cells of `mesh` to their new places, and with them everything attached: cells
/// follow their renumbered vertices, arrays their vertices and cells, sets their members.
///
/// Ids run in the new order: the numbers that the file gave stay the same numbers, rising along the new
/// places (cells: within each dimension of each block). Throws InvalidArgument when a size does not fit or
/// `cells` takes a cell out of its block or to the place of a cell of another dimension; the mesh is then
/// unchanged. O(size of the mesh) time; in memory a copy of its largest part at a time.
void apply_reordering(Mesh& mesh, const Permutation& vertices, const Permutation& cells);

/// The permutation that puts the cells of every dimension, within every block, into the given order and
/// leaves each (block, dimension) the places that it had. `cells_in_order` lists all cells, each once.
/// O(cells).
Permutation permutation_within_blocks(const Mesh& mesh, const std::vector<Index>& cells_in_order);

/// For formats that keep cells of one type together: groups the cells by dimension, highest first, and type,
/// otherwise in their order, makes each type a block and returns the permutation that it applied. A mesh
/// whose types already stand together keeps its order. O(size of the mesh).
Permutation group_cells_by_type(Mesh& mesh);

}  // namespace meshorder
