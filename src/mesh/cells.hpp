// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/text.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

/// The geometric shape of a cell. Shape and number of vertices make the cell type: a tetrahedron of 4
/// vertices is linear, one of 10 quadratic. The last four shapes have any number of vertices.
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

template <>
struct EnumNames<Shape> {
  static constexpr std::string_view kind = "shape";
  static constexpr std::array names{std::pair{Shape::vertex, "vertex"},
                                    std::pair{Shape::line, "line"},
                                    std::pair{Shape::triangle, "triangle"},
                                    std::pair{Shape::quad, "quad"},
                                    std::pair{Shape::tetrahedron, "tetrahedron"},
                                    std::pair{Shape::pyramid, "pyramid"},
                                    std::pair{Shape::wedge, "wedge"},
                                    std::pair{Shape::hexahedron, "hexahedron"},
                                    std::pair{Shape::poly_vertex, "poly_vertex"},
                                    std::pair{Shape::polyline, "polyline"},
                                    std::pair{Shape::polygon, "polygon"},
                                    std::pair{Shape::triangle_strip, "triangle_strip"}};
};

inline constexpr int kShapes = static_cast<int>(EnumNames<Shape>::names.size());

/// Returns the dimension of a shape: 0 for vertices … 3 for volumes.
int dimension(Shape shape);

/// Returns the number of corners of a cell with `vertices` vertices: 4 for every tetrahedron, all vertices of
/// a polygon.
int corners(Shape shape, int vertices);

/// Returns the name of the cell type: "tetrahedron", "tetrahedron10", "polygon".
std::string type_name(Shape shape, int vertices);

/// Returns the facets of a cell (faces of a volume, edges of a surface, ends of a line), each as positions of
/// its corners in the cell: `facets(Shape::triangle, 3)` is {{0, 1}, {1, 2}, {2, 0}}. Vertex shapes have
/// none; a triangle strip has the edges of its outline.
std::vector<std::vector<int>> facets(Shape shape, int vertices);

/// Cells of any types, mixed, in file order: cell c has shape `shapes[c]` and the vertices
/// `vertices[offsets[c]] … vertices[offsets[c + 1] − 1]`.
///
/// Corners come first, in VTK's order except for linear wedges: the first triangle of every wedge faces
/// inward, as in Gmsh. In second-order cells follow the nodes of edges, faces and interior, in VTK's order
/// for the types that VTK has. Higher orders keep the order of the file they came from.
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

  /// Returns the highest dimension of any cell, −1 without cells. O(cells).
  [[nodiscard]] int highest_dimension() const;

  bool operator==(const Cells&) const = default;
};

}  // namespace meshorder
