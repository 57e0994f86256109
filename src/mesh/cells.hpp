// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The geometric shape of a cell. With its number of vertices it is the cell's type: a tetrahedron of 4
/// vertices is linear, of 10 quadratic. The last four have any number of vertices.
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
};

inline constexpr int kShapes = 12;

/// 0 for vertices … 3 for volumes.
int dimension(Shape shape);

/// The corners of a cell of this shape with `vertices` vertices: 4 for every tetrahedron, all of a polygon's.
int corners(Shape shape, int vertices);

/// Lower-case name of the shape, "tetrahedron".
std::string_view name(Shape shape);

/// Name of the cell type: "tetrahedron", "tetrahedron10", "polygon".
std::string type_name(Shape shape, int vertices);

/// The facets of a cell (faces of a volume, edges of a surface, ends of a line), each as positions of its
/// corners in the cell: `facets(Shape::triangle, 3)` is {{0, 1}, {1, 2}, {2, 0}}. A triangle strip gives its
/// outline. Vertex shapes have none.
std::vector<std::vector<int>> facets(Shape shape, int vertices);

/// Cells of any types, mixed, in file order: cell c has shape `shapes[c]` and the vertices
/// `vertices[offsets[c]] … vertices[offsets[c + 1] − 1]`.
///
/// Corners come first, in VTK's order, but for linear wedges: the first triangle of every wedge faces inward,
/// as in Gmsh's; then, in second-order cells, the nodes of edges, faces and interior in VTK's order for the
/// types that VTK knows. Higher orders keep the order of the file they came from.
struct Cells {
  std::vector<Shape> shapes;
  std::vector<Offset> offsets{0};
  std::vector<Index> vertices;

  [[nodiscard]] Index size() const noexcept { return index_size(shapes); }
  [[nodiscard]] int vertex_count(Index cell) const {
    return static_cast<int>(offsets[cell + 1] - offsets[cell]);
  }
  [[nodiscard]] std::span<const Index> operator[](Index cell) const {
    return {vertices.data() + offsets[cell], vertices.data() + offsets[cell + 1]};
  }
  [[nodiscard]] std::span<Index> operator[](Index cell) {
    return {vertices.data() + offsets[cell], vertices.data() + offsets[cell + 1]};
  }
  void push_back(Shape shape, std::span<const Index> cell_vertices);
  void reserve(Offset cells, Offset vertex_entries);

  /// The highest dimension of any cell, −1 without cells. O(cells).
  [[nodiscard]] int highest_dimension() const;

  bool operator==(const Cells&) const = default;
};

}  // namespace meshorder
