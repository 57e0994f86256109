// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/format.hpp"

#include <string>
#include <vector>

namespace meshorder {

// Selects the cells of a mesh that go into a file. If the format cannot hold all cells of the highest
// dimension, the mesh is refused. Cells of lower dimensions that the format cannot hold are left out. All
// vertices stay.

/// Keeps only the cells at these ascending positions, with their arrays, sets, ids and blocks. Removes and
/// notes the sets and partial arrays that have no cells left. O(size of the mesh).
void keep_cells_at(Mesh& mesh, const std::vector<Index>& kept, Notes& notes);

/// Returns the positions of the cells to be written in the format, ascending: all cells if `strict` or if the
/// format lacks a type of the highest dimension. Notes the cells left out, a line for each type. Throws
/// InputError, which names the fitting formats, if a file of the format cannot hold the cells to be written:
/// the format lacks a type, or types conflict. O(cells); copies the mesh if cells are left out and the format
/// has a `conflict`.
std::vector<Index> cells_to_write(const Mesh& mesh, const FilePath& path, const Format& format, bool strict,
                                  Notes& notes);

/// As the public `keep_cells` for a valid mesh, with only the dimension given.
std::vector<Index> keep_dimension(Mesh& mesh, int wanted, Notes& notes);

}  // namespace meshorder
