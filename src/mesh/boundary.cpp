// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/boundary.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace meshorder {
namespace {

using Facets = std::vector<std::vector<int>>;

/// Looks up `facets`, which are the same for all cells of a type.
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

std::array<Index, 4> sorted_corners(std::span<const Index> cell, const std::vector<int>& positions) {
  std::array<Index, 4> corners{-1, -1, -1, -1};
  for (std::size_t k = 0; k < positions.size(); ++k) corners[k] = cell[positions[k]];
  std::sort(corners.begin(), corners.end(), std::greater<>());
  return corners;
}

/// Calls `visit(element, cell)` for every element.
template <class Visit>
void for_elements(const Mesh& mesh, Visit visit) {
  const int highest = mesh.cells.highest_dimension();
  Index element = 0;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (dimension(mesh.cells.shapes[c]) == highest) visit(element++, c);
  }
}

/// Keeps the facets of exactly one element, in ascending order of their elements.
void keep_unmatched(std::vector<ElementFacet>& facets) {
  auto kept = facets.begin();
  for (auto begin = facets.begin(); begin != facets.end();) {
    const auto end =
        std::find_if(begin, facets.end(), [&](const ElementFacet& f) { return f.corners != begin->corners; });
    if (end - begin == 1) *kept++ = *begin;
    begin = end;
  }
  facets.erase(kept, facets.end());
  std::sort(facets.begin(), facets.end(),
            [](const ElementFacet& a, const ElementFacet& b) { return a.element < b.element; });
}

/// Removes the facets of `element` from the front of `facets` and returns them.
std::span<const ElementFacet> take_facets_of(Index element, std::span<const ElementFacet>& facets) {
  std::size_t count = 0;
  while (count < facets.size() && facets[count].element == element) ++count;
  const auto result = facets.first(count);
  facets = facets.subspan(count);
  return result;
}

Point centre(const Mesh& mesh, std::span<const Index> vertices) {
  Point sum{};
  for (const Index v : vertices) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += mesh.points[v][c] / static_cast<double>(vertices.size());
  }
  return sum;
}

/// Adds a face of a cell as triangles that are counterclockwise seen from outside the cell.
void add_face(const Mesh& mesh, Index c, const std::vector<int>& positions,
              std::vector<std::array<Index, 3>>& triangles) {
  const auto cell = mesh.cells[c];
  std::vector<Index> face;
  face.reserve(positions.size());
  for (const int position : positions) face.push_back(cell[position]);
  const Point inner = centre(mesh, cell.first(corners(mesh.cells.shapes[c], static_cast<int>(cell.size()))));
  const Point& a = mesh.points[face[0]];
  // the product of a quadrilateral's diagonals, or of two sides of a triangle
  const Point normal =
      face.size() == 3
          ? cross(minus(mesh.points[face[1]], a), minus(mesh.points[face[2]], a))
          : cross(minus(mesh.points[face[2]], a), minus(mesh.points[face[3]], mesh.points[face[1]]));
  if (dot(normal, minus(centre(mesh, face), inner)) < 0) std::reverse(face.begin(), face.end());
  for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
}

}  // namespace

std::vector<ElementFacet> matched_facets(const std::vector<ElementFacet>& facets, Index vertex_count) {
  // bucket by the largest corner, then sort each bucket
  std::vector<Offset> starts(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const ElementFacet& facet : facets) ++starts[facet.corners[0] + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Offset> next(starts.begin(), starts.end() - 1);
  std::vector<ElementFacet> result(facets.size());
  for (const ElementFacet& facet : facets) result[next[facet.corners[0]]++] = facet;
  for (Index v = 0; v < vertex_count; ++v) {
    std::sort(result.begin() + starts[v], result.begin() + starts[v + 1],
              [](const ElementFacet& a, const ElementFacet& b) {
                return a.corners != b.corners ? a.corners < b.corners : a.element < b.element;
              });
  }
  return result;
}

std::vector<ElementFacet> matched_facets(const Mesh& mesh) {
  std::vector<ElementFacet> all;
  FacetsOfTypes facets_of;
  for_elements(mesh, [&](Index element, Index c) {
    for (const std::vector<int>& positions : facets_of(mesh, c)) {
      all.push_back({sorted_corners(mesh.cells[c], positions), element});
    }
  });
  return matched_facets(all, mesh.vertex_count());
}

std::vector<std::array<Index, 3>> boundary_triangles(const Mesh& mesh) {
  std::vector<std::array<Index, 3>> triangles;
  const int highest = mesh.cells.highest_dimension();
  if (highest < 2) {
    throw Error("the mesh", "has no surface: its cells have at most one dimension",
                "give one with cells of two or three dimensions");
  }
  if (highest == 2) {
    const Simplices simplices = cut_into_simplices(mesh);
    for (std::size_t i = 0; i < simplices.vertices.size(); i += 3)
      triangles.push_back({simplices.vertices[i], simplices.vertices[i + 1], simplices.vertices[i + 2]});
    return triangles;
  }
  std::vector<ElementFacet> outer = matched_facets(mesh);
  keep_unmatched(outer);
  std::span<const ElementFacet> left(outer);
  FacetsOfTypes facets_of;
  for_elements(mesh, [&](Index element, Index c) {
    const auto own = take_facets_of(element, left);
    if (own.empty()) return;
    for (const std::vector<int>& positions : facets_of(mesh, c)) {
      const auto corners = sorted_corners(mesh.cells[c], positions);
      if (std::any_of(own.begin(), own.end(), [&](const ElementFacet& f) { return f.corners == corners; })) {
        add_face(mesh, c, positions, triangles);
      }
    }
  });
  return triangles;
}

std::vector<Offset> boundary_faces(const Simplices& tetrahedra, Index vertex_count) {
  const auto count = static_cast<Index>(tetrahedra.size());
  const auto face = [&](Index t, int k) {
    std::array<Index, 4> corners{};
    std::copy_n(tetrahedra.vertices.begin() + 4 * Offset{t}, 4, corners.begin());
    corners[k] = -1;
    std::sort(corners.begin(), corners.end(), std::greater<>());
    return corners;
  };
  std::vector<ElementFacet> outer;
  outer.reserve(tetrahedra.vertices.size());
  for (Index t = 0; t < count; ++t) {
    for (int k = 0; k < 4; ++k) outer.push_back({face(t, k), t});
  }
  outer = matched_facets(outer, vertex_count);
  keep_unmatched(outer);
  std::vector<Offset> result;
  result.reserve(outer.size());
  std::span<const ElementFacet> left(outer);
  for (Index t = 0; t < count; ++t) {
    const auto own = take_facets_of(t, left);
    for (int k = 0; k < 4; ++k) {
      if (std::any_of(own.begin(), own.end(), [&](const ElementFacet& f) { return f.corners == face(t, k); }))
        result.push_back(4 * Offset{t} + k);
    }
  }
  return result;
}

}  // namespace meshorder
