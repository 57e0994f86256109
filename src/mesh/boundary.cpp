// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/point.hpp"
#include "cells/facets.hpp"
#include "mesh/graphs.hpp"
#include "mesh/simplices.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <functional>
#include <span>
#include <tuple>
#include <utility>

namespace meshorder {
namespace {

/// Calls `visit(element, cell)` with the number of each element and the number of its cell.
template <class Visit>
void for_elements(const Mesh& mesh, Visit visit) {
  const int highest = mesh.cells.highest_dimension();
  Index element = 0;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (dimension(mesh.cells.shapes[c]) == highest) visit(element++, c);
  }
}

/// Removes facets that several elements have; sorts the others by element. Equal facets must be adjacent.
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

/// Removes the facets whose corners all belong to one polyhedron: such a facet separates its element from the
/// polyhedron. Tests each facet against the polyhedra at the facet's corner with the fewest polyhedra.
void drop_facets_of_polyhedra(const Mesh& mesh, std::vector<ElementFacet>& facets) {
  std::vector<std::pair<Index, Index>> polyhedra;  // a vertex, and a polyhedron that has it as a corner
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (mesh.cells.shapes[c] != Shape::polyhedron) continue;
    for (const Index v : mesh.cells[c]) polyhedra.emplace_back(v, c);
  }
  if (polyhedra.empty()) return;
  std::sort(polyhedra.begin(), polyhedra.end());
  const auto of_vertex = [&](Index v) {
    return std::pair(std::lower_bound(polyhedra.begin(), polyhedra.end(), std::pair(v, Index{0})),
                     std::lower_bound(polyhedra.begin(), polyhedra.end(), std::pair(v + 1, Index{0})));
  };
  std::erase_if(facets, [&](const ElementFacet& facet) {
    auto [first, last] = of_vertex(facet.corners[0]);
    for (const Index corner : facet.corners) {
      const auto others = corner < 0 ? std::pair(first, last) : of_vertex(corner);
      if (others.second - others.first < last - first) std::tie(first, last) = others;
    }
    return std::any_of(first, last, [&](const std::pair<Index, Index>& at) {
      const auto cell = mesh.cells[at.second];
      return std::all_of(facet.corners.begin(), facet.corners.end(), [&](Index corner) {
        return corner < 0 || std::find(cell.begin(), cell.end(), corner) != cell.end();
      });
    });
  });
}

/// Removes the facets of `element` from the front of `facets` and returns the removed facets.
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

/// Adds a face of a cell as triangles that are counterclockwise as seen from outside the cell.
void add_face(const Mesh& mesh, Index c, const std::vector<int>& positions,
              std::vector<std::array<Index, 3>>& triangles) {
  const auto cell = mesh.cells[c];
  std::vector<Index> face;
  face.reserve(positions.size());
  for (const int position : positions) face.push_back(cell[position]);
  const Point inner = centre(mesh, cell.first(corners(mesh.cells.shapes[c], static_cast<int>(cell.size()))));
  const Point& a = mesh.points[face[0]];
  // for a triangle, the cross product of two sides; for a quadrilateral, that of the diagonals
  const Point normal =
      face.size() == 3
          ? cross(minus(mesh.points[face[1]], a), minus(mesh.points[face[2]], a))
          : cross(minus(mesh.points[face[2]], a), minus(mesh.points[face[3]], mesh.points[face[1]]));
  if (dot(normal, minus(centre(mesh, face), inner)) < 0) std::reverse(face.begin(), face.end());
  for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
}

}  // namespace

std::vector<std::array<Index, 3>> boundary_triangles(const Mesh& mesh) {
  std::vector<std::array<Index, 3>> triangles;
  const int highest = mesh.cells.highest_dimension();
  if (highest < 2) {
    throw InputError("the mesh", "has no surface: its cells have at most one dimension",
                     "give one with cells of two or three dimensions");
  }
  if (highest == 2) {
    const Simplices simplices = cut_into_simplices(mesh);
    for (std::size_t i = 0; i < simplices.vertices.size(); i += 3)
      triangles.push_back({simplices.vertices[i], simplices.vertices[i + 1], simplices.vertices[i + 2]});
    return triangles;
  }
  const CellArrays cells = cell_arrays(mesh);
  std::vector<ElementFacet> outer = matched_facets(cells, CellSelection::elements(cells));
  keep_unmatched(outer);
  drop_facets_of_polyhedra(mesh, outer);
  std::span<const ElementFacet> left(outer);
  FacetsOfTypes facets_of;
  for_elements(mesh, [&](Index element, Index c) {
    const auto own = take_facets_of(element, left);
    if (own.empty()) return;
    for (const std::vector<int>& positions : facets_of(mesh.cells.shapes[c], mesh.cells.vertex_count(c))) {
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
