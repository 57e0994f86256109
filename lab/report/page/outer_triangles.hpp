// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <array>
#include <vector>

namespace meshorder {

/// Returns the outer surface of a mesh as triangles over linear vertices, in the sequence of cells: faces of
/// volume cells that belong to one cell only, cavities included; the cells of a surface mesh. Quadrilaterals
/// and polygons are cut into triangles. Faces of volume cells are anticlockwise as seen from outside,
/// whatever the orientation of the cell, unless its volume is 0. Throws Error for a mesh without cells of two
/// or three dimensions. O(faces · log faces).
std::vector<std::array<Index, 3>> outer_triangles(const Mesh& mesh);

}  // namespace meshorder
