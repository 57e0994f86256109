// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/vtk/vtk.hpp"

#include <string>
#include <vector>

namespace meshorder::vtk {

/// What the pieces of a mesh hold, one after another. Borrowed from a reader.
struct Pieces {
  std::vector<Point>& points;
  FileCells& cells;
  std::vector<DataArray>& arrays;  ///< of all points or cells
  std::vector<ArrayRole>& roles;
};

/// Makes one mesh of its pieces, in place. Cells that `vtkGhostType` marks as another piece's are left out,
/// and points that only these use; `vtkGhostType` is left out itself where it says nothing else. Points and
/// cells with global ids, an array of that role or of the name that VTK gives it, are sorted by them, and a
/// point that several pieces have is one, with the values of the piece that owns it; the ids are left out
/// where they are 0, 1, 2 …
///
/// Without ids of the points those on the borders of pieces stay several, which is noted. Throws `error` for
/// ids below 0, points of one id that differ in place, and two cells of one id. O(points + cells, times their
/// logarithms).
void join_pieces(const Pieces& pieces, const ErrorAt& error, Notes& notes);

}  // namespace meshorder::vtk
