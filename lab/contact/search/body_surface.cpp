// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/body_surface.hpp"

#include "base/point.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace meshorder {
namespace {

/// Face k is opposite to corner k, and counterclockwise seen from outside of a tetrahedron whose corners 1,
/// 2, 3 are counterclockwise seen from outside, that is, of positive volume.
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
  struct Face {
    std::array<Index, 3> key{};
    Offset number = 0;  // 4 · tetrahedron + face
  };
  std::vector<Face> faces;
  faces.reserve(simplices.vertices.size());
  for (Offset t = 0; 4 * t < static_cast<Offset>(simplices.vertices.size()); ++t) {
    const Index* const corner = simplices.vertices.data() + 4 * t;
    for (int k = 0; k < 4; ++k) {
      Face face{{corner[kFaces[k][0]], corner[kFaces[k][1]], corner[kFaces[k][2]]}, 4 * t + k};
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return a.key < b.key || (a.key == b.key && a.number < b.number);
  });
  std::vector<Offset> alone;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    if (end == i + 1) alone.push_back(faces[i].number);
    i = end;
  }
  std::sort(alone.begin(), alone.end());

  BodySurface result;
  for (const Offset number : alone) {
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
