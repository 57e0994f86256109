// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/format.hpp"

#include <span>
#include <string>
#include <vector>

namespace meshorder {

// Which cells of a mesh a file of a format gets. Cells of the highest dimension are what a mesh is for: where
// the format cannot hold them all, the mesh is refused. Cells of lower dimensions that it cannot hold are
// left out. Vertices always stay.

/// Returns the positions of all cells: 0, 1, …
std::vector<Index> all_cells(const Mesh& mesh);

/// Returns the positions of the cells that a file of the format gets, ascending: all cells where the format
/// has no place for one of the highest dimension. Notes the others, one line for each type. O(cells).
std::vector<Index> cells_for(const Mesh& mesh, const Format& format, Notes& notes);

/// Keeps the cells at these ascending positions with their arrays, sets, ids and blocks, and notes the sets
/// and arrays that have no cells any more and go. O(size of the mesh).
void keep_cells_at(Mesh& mesh, const std::vector<Index>& kept, Notes& notes);

/// Returns why a file of the format cannot hold the cells of a mesh that were kept for it; an empty text if
/// it can. O(cells).
std::string fault_of_cells(const Mesh& mesh, const Format& format);

/// Returns "write .msh or .vtu", the formats that hold all cells of a mesh. O(cells · formats).
std::string advice_on_formats(const Mesh& mesh);

/// Returns the rows of values that `rows` names, `components` values each. O(values that are returned).
Values rows_of_values(const Values& values, Index components, std::span<const Index> rows);

/// Throws InputError with `fault_of_cells` of the cells at the positions `kept`, and with the formats that
/// hold all cells of the mesh, if a file of the format cannot hold these cells. O(cells); for a format with a
/// `conflict` a copy of the mesh, unless `kept` has all of them.
void require_held_cells(const Mesh& mesh, const std::vector<Index>& kept, const FilePath& path,
                        const Format& format);

}  // namespace meshorder
