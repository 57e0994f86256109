// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/cells.hpp"

#include <algorithm>
#include <array>

namespace meshorder {
namespace {

struct ShapeFacts {
  int dimension;
  int corners;  // 0: every vertex is a corner
};

constexpr std::array<ShapeFacts, kShapes> kFacts{
    {{0, 1}, {1, 2}, {2, 3}, {2, 4}, {3, 4}, {3, 5}, {3, 6}, {3, 8}, {0, 0}, {1, 0}, {2, 0}, {2, 0}}};

const ShapeFacts& facts(Shape shape) { return kFacts[static_cast<std::size_t>(shape)]; }

}  // namespace

int dimension(Shape shape) { return facts(shape).dimension; }

int corners(Shape shape, int vertices) {
  const int fixed = facts(shape).corners;
  return fixed > 0 ? fixed : vertices;
}

std::string type_name(Shape shape, int vertices) {
  std::string result(to_string(shape));
  if (facts(shape).corners > 0 && vertices != facts(shape).corners) result += std::to_string(vertices);
  return result;
}

std::vector<std::vector<int>> facets(Shape shape, int vertices) {
  switch (shape) {
    case Shape::line:
      return {{0}, {1}};
    case Shape::polyline:
      return {{0}, {vertices - 1}};
    case Shape::triangle:
    case Shape::quad:
    case Shape::polygon: {
      const int n = corners(shape, vertices);
      std::vector<std::vector<int>> edges;
      edges.reserve(n);
      for (int i = 0; i < n; ++i) edges.push_back({i, (i + 1) % n});
      return edges;
    }
    case Shape::tetrahedron:
      return {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
    case Shape::pyramid:
      return {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    case Shape::wedge:
      return {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
    case Shape::hexahedron:
      return {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
    case Shape::triangle_strip: {
      if (vertices < 2) return {};
      std::vector<std::vector<int>> edges{{0, 1}};
      for (int i = 2; i < vertices; ++i) edges.push_back({i - 2, i});
      edges.push_back({vertices - 2, vertices - 1});
      return edges;
    }
    case Shape::vertex:
    case Shape::poly_vertex:
      return {};
  }
  return {};
}

void Cells::push_back(Shape shape, std::span<const Index> cell_vertices) {
  shapes.push_back(shape);
  vertices.insert(vertices.end(), cell_vertices.begin(), cell_vertices.end());
  offsets.push_back(static_cast<Offset>(vertices.size()));
}

void Cells::reserve(Offset cells, Offset vertex_entries) {
  shapes.reserve(cells);
  offsets.reserve(cells + 1);
  vertices.reserve(vertex_entries);
}

int Cells::highest_dimension() const {
  int highest = -1;
  for (int shape = 0; shape < kShapes; ++shape) {
    const auto s = static_cast<Shape>(shape);
    if (dimension(s) > highest && std::find(shapes.begin(), shapes.end(), s) != shapes.end()) {
      highest = dimension(s);
    }
  }
  return highest;
}

}  // namespace meshorder
