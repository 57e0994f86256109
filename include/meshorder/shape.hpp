// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// The geometric shape of a cell. Shape and number of vertices together are the type of a cell: a tetrahedron
/// of 4 vertices is linear, one of 10 is quadratic. The last five shapes have any number of vertices.
///
/// Corners come first, in VTK's order, except in linear wedges. The first triangle of every wedge faces
/// inward, as in Gmsh. In second-order cells the nodes of edges, faces and interior follow, in VTK's order. A
/// polyhedron has the corners of its faces, each once, in any order. The faces themselves are not part of the
/// cell; the metadata of the file's format keep them.
enum class Shape : std::uint8_t {
  vertex,
  line,
  triangle,
  quad,
  tetrahedron,
  pyramid,
  wedge,
  hexahedron,
  poly_vertex,
  polyline,
  polygon,
  triangle_strip,
  polyhedron,
};

/// Number of values of `Shape`.
inline constexpr int kShapes = 13;

/// Returns the dimension of a shape: 0 for vertices, 1 for lines, 2 for surfaces, 3 for volumes. O(1).
MESHORDER_API int dimension(Shape shape);

/// Returns the number of corners of a cell: 4 for every tetrahedron, all vertices of a polygon. O(1).
///
/// @param shape     shape of the cell
/// @param vertices  number of its vertices, ≥ 1
MESHORDER_API int corners(Shape shape, int vertices);

/// Returns the name of a shape, lower case: "tetrahedron", "poly_vertex". O(1). Valid for the life of the
/// program.
MESHORDER_API std::string_view to_string(Shape shape);

/// Returns the name of a cell type: "tetrahedron" for a linear one, "tetrahedron10" for a quadratic one.
MESHORDER_API std::string type_name(Shape shape, int vertices);

/// Returns the facets of a cell: faces of a volume, edges of a surface, ends of a line.
///
/// @return for each facet the positions, from 0, of its corners in the cell: `facets(Shape::triangle, 3)` is
///         {{0, 1}, {1, 2}, {2, 0}}. For a triangle strip, its outline. Empty for vertex shapes, and for
///         polyhedra, whose facets are not known.
MESHORDER_API std::vector<std::vector<int>> facets(Shape shape, int vertices);

}  // namespace v0_3
}  // namespace meshorder
