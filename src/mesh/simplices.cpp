// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/simplices.hpp"

#include <algorithm>

namespace meshorder {
namespace {

/// Returns the corners of a cell's simplices as positions in the cell, D + 1 for each.
std::vector<int> pieces(Shape shape, int vertices) {
  switch (shape) {
    case Shape::line:
      return {0, 1};
    case Shape::tetrahedron:
      return {0, 1, 2, 3};
    case Shape::pyramid:
      return {0, 1, 2, 4, 0, 2, 3, 4};
    case Shape::wedge:
      return {0, 2, 1, 3, 1, 2, 4, 3, 2, 5, 4, 3};
    case Shape::hexahedron:  // around the diagonal from 0 to 6
      return {0, 1, 2, 6, 0, 2, 3, 6, 0, 3, 7, 6, 0, 7, 4, 6, 0, 4, 5, 6, 0, 5, 1, 6};
    case Shape::polyline: {
      std::vector<int> lines;
      for (int i = 1; i < vertices; ++i) lines.insert(lines.end(), {i - 1, i});
      return lines;
    }
    case Shape::triangle:
    case Shape::quad:
    case Shape::polygon: {
      std::vector<int> fan;
      for (int i = 2; i < corners(shape, vertices); ++i) fan.insert(fan.end(), {0, i - 1, i});
      return fan;
    }
    case Shape::triangle_strip: {
      std::vector<int> strip;
      for (int i = 2; i < vertices; ++i) strip.insert(strip.end(), {i - 2, i - 1, i});
      return strip;
    }
    case Shape::polyhedron: {
      std::vector<int> chain;
      for (int i = 3; i < vertices; ++i) chain.insert(chain.end(), {i - 3, i - 2, i - 1, i});
      return chain;
    }
    case Shape::vertex:
    case Shape::poly_vertex:
      return {};
  }
  return {};
}

}  // namespace

Simplices cut_into_simplices(const Mesh& mesh) {
  Simplices result;
  result.dimension = std::max(0, mesh.cells.highest_dimension());
  if (result.dimension == 0) return result;
  Shape shape = Shape::vertex;
  int vertices = 0;
  std::vector<int> cut;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (dimension(mesh.cells.shapes[c]) != result.dimension) continue;
    if (mesh.cells.shapes[c] != shape || mesh.cells.vertex_count(c) != vertices) {
      shape = mesh.cells.shapes[c];
      vertices = mesh.cells.vertex_count(c);
      cut = pieces(shape, vertices);
    }
    for (const int corner : cut) result.vertices.push_back(mesh.cells[c][corner]);
    result.cells.insert(result.cells.end(), cut.size() / (result.dimension + 1), c);
  }
  return result;
}

}  // namespace meshorder
