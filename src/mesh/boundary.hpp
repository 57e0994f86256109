// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/simplices.hpp"

#include <array>
#include <vector>

namespace meshorder {

/// Returns the visible surface of a mesh as triangles on its corners. For volumes: the faces of exactly one
/// cell, including those of cavities, counterclockwise as seen from outside for either orientation of the
/// cell (a cell without volume leaves its faces as they are). For a surface mesh: its cells. Quadrilaterals
/// and polygons are cut into fans. Faces of polyhedra are not known and are left out, as are the faces of
/// other cells whose corners all belong to one polyhedron. Triangles are in the order of cells. Throws
/// InputError for a mesh without cells of two or three dimensions. O(facets · log facets at a vertex), and
/// for polyhedra their corners there.
std::vector<std::array<Index, 3>> boundary_triangles(const Mesh& mesh);

/// Returns the faces that exactly one tetrahedron has, ascending, as 4 · tetrahedron + k; face k is opposite
/// to corner k. `vertex_count` exceeds every vertex. O(faces · log faces at a vertex).
std::vector<Offset> boundary_faces(const Simplices& tetrahedra, Index vertex_count);

}  // namespace meshorder
