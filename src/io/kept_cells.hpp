// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/format.hpp"

#include <string>
#include <vector>

namespace meshorder {

// Selects the cells of a mesh that go into a file. If the format cannot hold all cells of the highest
// dimension, the mesh is refused. Cells of lower dimensions that it cannot hold are left out. All vertices
// stay.

/// Returns the positions of all cells: 0, 1, …
std::vector<Index> all_cells(const Mesh& mesh);

/// Returns the positions of the cells to be written in the format, ascending: all cells if the format lacks a
/// type of the highest dimension. Notes the cells left out, a line for each type. O(cells).
std::vector<Index> cells_for(const Mesh& mesh, const Format& format, Notes& notes);

/// Keeps the cells at these ascending positions with their arrays, sets, ids and blocks. Removes and notes
/// the sets and partial arrays that have no cells left. O(size of the mesh).
void keep_cells_at(Mesh& mesh, const std::vector<Index>& kept, Notes& notes);

/// Returns why a file of the format cannot hold all cells of a mesh: a type that the format cannot hold,
/// or a conflict of types. Returns an empty text if the file can hold all cells. O(cells).
std::string fault_of_cells(const Mesh& mesh, const Format& format);

/// Returns advice such as "write .msh or .vtu": formats that hold all cells of a mesh. O(cells · formats).
std::string advice_on_formats(const Mesh& mesh);

/// Throws InputError if a file of the format cannot hold the cells at the positions `kept`; the error has the
/// texts of `fault_of_cells` and `advice_on_formats`. O(cells); for a format with a `conflict` it copies the
/// mesh, unless `kept` has all cells.
void require_held_cells(const Mesh& mesh, const std::vector<Index>& kept, const FilePath& path,
                        const Format& format);

}  // namespace meshorder
