// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"

#include <array>
#include <vector>

namespace meshorder {

/// What is seen of a mesh from outside: of volumes the faces that one cell alone has, on its corners, those
/// of cavities too; of a surface mesh its cells. Quadrilaterals and polygons are cut into triangles. Faces of
/// volumes turn anticlockwise as seen from outside, whichever way their cells turn; a cell without volume
/// leaves them as they are. In the order of cells. Throws Error for a mesh without cells of two or
/// three dimensions. O(faces · log faces).
std::vector<std::array<Index, 3>> outer_triangles(const Mesh& mesh);

}  // namespace meshorder
