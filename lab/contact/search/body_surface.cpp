// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/body_surface.hpp"

#include "mesh/simplices.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace meshorder {
namespace {

/// Face k is opposite to corner k. In a tetrahedron of positive volume, the corners of each face are
/// counterclockwise seen from outside.
constexpr std::array<std::array<int, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

void check(const Simplices& simplices, std::size_t points) {
  if (simplices.dimension != 3 && !simplices.vertices.empty()) {
    throw InvalidArgument(fmt::format("contacts are found on tetrahedra; these simplices have {} dimensions",
                                      simplices.dimension));
  }
  for (const Index v : simplices.vertices) {
    if (v < 0 || static_cast<std::size_t>(v) >= points)
      throw InvalidArgument(fmt::format("a tetrahedron names vertex {}, but there are {} points", v, points));
  }
}

}  // namespace

BodySurface body_surface(const Simplices& simplices, std::span<const Point> points) {
  check(simplices, points.size());
  BodySurface result;
  for (const Offset number : boundary_faces(simplices, static_cast<Index>(points.size()))) {
    const Index* const corner = simplices.vertices.data() + number / 4 * 4;
    const std::array<int, 3>& face = kFaces[number % 4];
    std::array<Index, 3> triangle{corner[face[0]], corner[face[1]], corner[face[2]]};
    const Point& a = points[corner[0]];
    const double volume =
        dot(minus(points[corner[1]], a), cross(minus(points[corner[2]], a), minus(points[corner[3]], a)));
    if (volume < 0.0) std::swap(triangle[1], triangle[2]);
    result.vertices.insert(result.vertices.end(), triangle.begin(), triangle.end());
    result.triangles.push_back(triangle);
  }
  std::sort(result.vertices.begin(), result.vertices.end());
  result.vertices.erase(std::unique(result.vertices.begin(), result.vertices.end()), result.vertices.end());
  return result;
}

}  // namespace meshorder
