// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/vtk/vtk.hpp"

#include <string>
#include <vector>

namespace meshorder::vtk {

/// The contents of the pieces of a mesh, one piece after another. Refers to members of a reader.
struct Pieces {
  std::vector<Point>& points;
  FileCells& cells;
  std::vector<DataArray>& arrays;  ///< of all points or cells
  std::vector<ArrayRole>& roles;
};

/// Makes one mesh of its pieces, in place. Leaves out cells that `vtkGhostType` marks as another piece's,
/// points that it marks and that no remaining cell uses, and `vtkGhostType` itself if it marks nothing else.
/// Sorts points and cells by their global ids, which are in the array of that role or of VTK's name for it. A
/// point of several pieces becomes one, with the values of the piece that owns it. Leaves out ids that are 0,
/// 1, 2 …
///
/// Points without ids on the borders of pieces stay once for each piece, which is noted. Throws `error` for
/// ids below 0, for points with one id but different coordinates, and for two cells with one id. O(points +
/// cells, times their logarithms).
void join_pieces(const Pieces& pieces, const ErrorAt& error, Notes& notes);

}  // namespace meshorder::vtk
