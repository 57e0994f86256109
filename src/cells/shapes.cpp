// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/shape.hpp>

#include <array>
#include <cstddef>

namespace meshorder {
inline namespace v0_3 {
namespace {

struct ShapeFacts {
  std::string_view name;
  int dimension;
  int corners;  // 0: every vertex is a corner
};

constexpr std::array<ShapeFacts, kShapes> kFacts{{{"vertex", 0, 1},
                                                  {"line", 1, 2},
                                                  {"triangle", 2, 3},
                                                  {"quad", 2, 4},
                                                  {"tetrahedron", 3, 4},
                                                  {"pyramid", 3, 5},
                                                  {"wedge", 3, 6},
                                                  {"hexahedron", 3, 8},
                                                  {"poly_vertex", 0, 0},
                                                  {"polyline", 1, 0},
                                                  {"polygon", 2, 0},
                                                  {"triangle_strip", 2, 0},
                                                  {"polyhedron", 3, 0}}};

const ShapeFacts& facts(Shape shape) { return kFacts[static_cast<std::size_t>(shape)]; }

}  // namespace

int dimension(Shape shape) { return facts(shape).dimension; }

int corners(Shape shape, int vertices) {
  const int fixed = facts(shape).corners;
  return fixed > 0 ? fixed : vertices;
}

std::string_view to_string(Shape shape) { return facts(shape).name; }

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
      return {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
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
    case Shape::polyhedron:
      return {};
  }
  return {};
}

}  // namespace v0_3
}  // namespace meshorder
