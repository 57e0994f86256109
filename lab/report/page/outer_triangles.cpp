// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/outer_triangles.hpp"

#include "base/point.hpp"
#include "kernels/simplices.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace meshorder {
namespace {

using Facets = std::vector<std::vector<int>>;

/// The facets of the cells of a mesh, which are the same for all cells of a type.
class FacetsOfTypes {
 public:
  const Facets& operator()(const Mesh& mesh, Index cell) {
    const auto type = std::pair(mesh.cells.shapes[cell], mesh.cells.vertex_count(cell));
    const auto found = by_type_.find(type);
    if (found != by_type_.end()) return found->second;
    return by_type_.emplace(type, facets(type.first, type.second)).first->second;
  }

 private:
  std::map<std::pair<Shape, int>, Facets> by_type_;
};

/// A face of a cell, known by its corners in falling order.
struct Face {
  std::array<Index, 4> corners{-1, -1, -1, -1};
  Index cell = 0;
  int number = 0;  // among the cell's facets
};

std::vector<Face> faces_of_volumes(const Mesh& mesh, FacetsOfTypes& facets_of) {
  std::vector<Face> faces;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (dimension(mesh.cells.shapes[c]) != 3) continue;
    const Facets& all = facets_of(mesh, c);
    for (int number = 0; number < static_cast<int>(all.size()); ++number) {
      Face face{.cell = c, .number = number};
      for (std::size_t k = 0; k < all[number].size(); ++k) face.corners[k] = mesh.cells[c][all[number][k]];
      std::sort(face.corners.begin(), face.corners.end(), std::greater<>());
      faces.push_back(face);
    }
  }
  return faces;
}

/// Leaves the faces that are there once, in the order of cells.
void keep_single(std::vector<Face>& faces) {
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.corners < b.corners; });
  auto kept = faces.begin();
  for (auto begin = faces.begin(); begin != faces.end();) {
    const auto end =
        std::find_if(begin, faces.end(), [&](const Face& face) { return face.corners != begin->corners; });
    if (end - begin == 1) *kept++ = *begin;
    begin = end;
  }
  faces.erase(kept, faces.end());
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::tie(a.cell, a.number) < std::tie(b.cell, b.number);
  });
}

Point middle(const Mesh& mesh, std::span<const Index> vertices) {
  Point sum{};
  for (const Index v : vertices) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += mesh.points[v][c] / static_cast<double>(vertices.size());
  }
  return sum;
}

/// A face of a cell as triangles that are seen anticlockwise from the side where the cell is not.
void add_face(const Mesh& mesh, const Face& face, const std::vector<int>& facet,
              std::vector<std::array<Index, 3>>& triangles) {
  const auto cell = mesh.cells[face.cell];
  std::vector<Index> corners;
  corners.reserve(facet.size());
  for (const int position : facet) corners.push_back(cell[position]);
  const auto inner = middle(
      mesh, cell.first(meshorder::corners(mesh.cells.shapes[face.cell], static_cast<int>(cell.size()))));
  const Point& a = mesh.points[corners[0]];
  // of a quadrilateral its diagonals, of a triangle two sides: their product is the area either way
  const Point normal =
      corners.size() == 3
          ? cross(minus(mesh.points[corners[1]], a), minus(mesh.points[corners[2]], a))
          : cross(minus(mesh.points[corners[2]], a), minus(mesh.points[corners[3]], mesh.points[corners[1]]));
  if (dot(normal, minus(middle(mesh, corners), inner)) < 0) std::reverse(corners.begin(), corners.end());
  for (std::size_t k = 2; k < corners.size(); ++k)
    triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

}  // namespace

std::vector<std::array<Index, 3>> outer_triangles(const Mesh& mesh) {
  std::vector<std::array<Index, 3>> triangles;
  const int highest = mesh.cells.highest_dimension();
  if (highest < 2) {
    throw InputError("the mesh", "has neither volumes nor a surface, so that nothing can be shown",
                     "give one with cells of two or three dimensions");
  }
  if (highest == 2) {
    const Simplices simplices = cut_into_simplices(mesh);
    for (std::size_t i = 0; i < simplices.vertices.size(); i += 3)
      triangles.push_back({simplices.vertices[i], simplices.vertices[i + 1], simplices.vertices[i + 2]});
    return triangles;
  }
  FacetsOfTypes facets_of;
  std::vector<Face> faces = faces_of_volumes(mesh, facets_of);
  keep_single(faces);
  for (const Face& face : faces) add_face(mesh, face, facets_of(mesh, face.cell)[face.number], triangles);
  return triangles;
}

}  // namespace meshorder
