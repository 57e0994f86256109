// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/body_surface.hpp"
#include "lab/contact/search/contact.hpp"
#include "lab/contact/search/rest_surface.hpp"
#include "lab/contact/search/tetrahedron_search.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Contact of a body's surface with the body itself (McAdams et al. 2011; Overby et al. 2017). A vertex of
/// the surface that is inside a tetrahedron is mapped by this tetrahedron to a point of the rest shape. The
/// vertex must leave through the point of the surface that is nearest to that point.
class SelfContact {
 public:
  SelfContact(const Simplices& simplices, std::span<const Point> points, const BodySurface& surface);

  /// Appends a contact for each vertex of the surface inside a tetrahedron of other vertices, by ascending
  /// vertex. Of several tetrahedra, uses the first of those in which the vertex is deepest.
  ///
  /// The way out is through the triangle of the surface that is nearest in the rest shape. Triangles of the
  /// vertex itself are left out: a contact with these would have no effect. The contact's normal is that
  /// of the deformed triangle; a triangle without area makes no contact.
  void find(std::span<const double> positions, double friction, std::vector<Contact>& contacts);

  /// Returns the number of vertices of the surface that are inside tetrahedra of other vertices.
  [[nodiscard]] Index vertices_inside(std::span<const double> positions);

  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Returns the nearest point of the rest surface, among triangles without the vertex.
  [[nodiscard]] RestSurface::Place way_out(const VertexInside& inside) const;

  std::vector<Point> rest_;
  std::vector<bool> on_surface_;
  RestSurface surface_;
  TetrahedronSearch search_;
  std::vector<VertexInside> inside_;
};

}  // namespace meshorder
