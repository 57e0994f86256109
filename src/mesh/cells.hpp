// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include <meshorder/shape.hpp>

#include <span>
#include <vector>

namespace meshorder {

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
