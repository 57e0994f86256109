// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/fluid/alpha_shape.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

constexpr double kAlpha = 1.35;  ///< bound of a circumscribed sphere's radius, in spacings
constexpr double kFlat = 0.003;  ///< volume of the flattest tetrahedron that is integrated, in cubic spacings

enum class Kind : std::uint8_t { outside, flat, inside };

Kind kind_of(const std::array<Index, 4>& corners, std::span<const Point> points, double spacing,
             double flat) {
  const Point& origin = points[corners[0]];
  std::array<Point, 3> edges{};
  for (int i = 0; i < 3; ++i) edges[i] = minus(points[corners[i + 1]], origin);
  const std::array<Point, 3> normals{cross(edges[1], edges[2]), cross(edges[2], edges[0]),
                                     cross(edges[0], edges[1])};
  const double six_volumes = dot(edges[0], normals[0]);
  Point centre{};  // of the sphere, relative to `origin`; multiplied by 12 times the volume
  for (int i = 0; i < 3; ++i) centre = plus_scaled(centre, dot(edges[i], edges[i]), normals[i]);
  if (!(norm(centre) < kAlpha * spacing * 2 * std::abs(six_volumes))) return Kind::outside;
  return six_volumes > 6 * flat ? Kind::inside : Kind::flat;
}

/// The corners of the face opposite each corner, anticlockwise as seen from outside.
constexpr std::array<std::array<int, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

}  // namespace

Cells FluidMesh::cells() const {
  Cells cells;
  cells.shapes.assign(corners.size() / 4, Shape::tetrahedron);
  cells.vertices = corners;
  cells.offsets.resize(corners.size() / 4 + 1);
  for (std::size_t cell = 0; cell < cells.offsets.size(); ++cell)
    cells.offsets[cell] = static_cast<Offset>(4 * cell);
  return cells;
}

FluidMesh alpha_shape(const Triangulation& triangulation, std::span<const Point> points,
                      std::span<const Walls> walls, double spacing) {
  const double flat = kFlat * spacing * spacing * spacing;
  const auto count = static_cast<Index>(triangulation.corners.size());
  std::vector<Kind> kinds(triangulation.corners.size());
  for_each_chunk(count, kParticlesInChunk, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index t = begin; t < end; ++t) kinds[t] = kind_of(triangulation.corners[t], points, spacing, flat);
  });
  FluidMesh mesh;
  mesh.flat = flat;
  mesh.alone.assign(points.size(), 1);
  mesh.free.assign(points.size(), 0);
  mesh.corners.reserve(4 * triangulation.corners.size());
  for (Index t = 0; t < count; ++t) {
    if (kinds[t] == Kind::outside) continue;
    const std::array<Index, 4>& corners = triangulation.corners[t];
    for (int face = 0; face < 4; ++face) {
      const Index beyond = triangulation.neighbours[t][face];
      if (beyond >= 0 && kinds[beyond] != Kind::outside) continue;
      Walls common = 0xff;
      for (const int i : kFaces[face]) common &= walls[corners[i]];
      if (common != kNoWalls) continue;
      for (const int i : kFaces[face]) mesh.free[corners[i]] = 1;
    }
    if (kinds[t] == Kind::inside) {
      for (const Index v : corners) mesh.alone[v] = 0;
    }
    mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
  }
  for (std::size_t v = 0; v < points.size(); ++v) mesh.free[v] |= mesh.alone[v];
  return mesh;
}

std::vector<std::array<Index, 3>> outer_faces(const FluidMesh& mesh) {
  using Face = std::array<Index, 3>;
  struct Side {
    Face sorted, outward;
  };
  std::vector<Side> sides;
  sides.reserve(mesh.corners.size());
  for (std::size_t at = 0; at < mesh.corners.size(); at += 4) {
    for (const std::array<int, 3>& face : kFaces) {
      Side side;
      for (int i = 0; i < 3; ++i) side.outward[i] = mesh.corners[at + face[i]];
      side.sorted = side.outward;
      std::ranges::sort(side.sorted);
      sides.push_back(side);
    }
  }
  std::ranges::sort(sides, {}, &Side::sorted);
  std::vector<Face> faces;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i + 1 < sides.size() && sides[i].sorted == sides[i + 1].sorted) {
      ++i;
      continue;
    }
    faces.push_back(sides[i].outward);
  }
  return faces;
}

}  // namespace meshorder
