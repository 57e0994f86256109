// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/self_contact.hpp"

#include "base/parallel.hpp"
#include "kernels/positions.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace meshorder {
namespace {

constexpr Index kPlacesAtOnce = 64;  // number of vertices for which a task finds nearest points

/// Makes the contact of a vertex with a point of the surface. Returns false if the triangle has no area.
bool make_contact(Index vertex, const std::array<Index, 3>& triangle, const std::array<double, 3>& weights,
                  double friction, std::span<const double> positions, Contact& contact) {
  const std::optional<Point> normal = triangle_normal(positions, triangle[0], triangle[1], triangle[2]);
  if (!normal) return false;
  contact.vertices = {vertex, triangle[0], triangle[1], triangle[2]};
  contact.weights = {1.0, -weights[0], -weights[1], -weights[2]};
  contact.normal = *normal;
  contact.offset = 0.0;
  contact.friction = friction;
  contact.with = -1;
  return true;
}

}  // namespace

SelfContact::SelfContact(const Simplices& simplices, std::span<const Point> points,
                         const BodySurface& surface)
    : rest_(points.begin(), points.end()),
      on_surface_(points.size(), false),
      surface_(surface.triangles, points),
      search_(simplices, points, surface.vertices) {
  for (const Index v : surface.vertices) on_surface_[v] = true;
}

RestSurface::Place SelfContact::way_out(const VertexInside& inside) const {
  constexpr double kAboveRounding = 1.0 + 1e-6;
  const std::array<Index, 4> corners = search_.corners(inside.tetrahedron);
  Point place{};
  for (int k = 0; k < 4; ++k) place = plus_scaled(place, inside.weights[k], rest_[corners[k]]);
  // upper bound: the distance to any corner on the surface; each has a triangle without the vertex
  double within = std::numeric_limits<double>::infinity();
  for (const Index corner : corners) {
    if (on_surface_[corner]) within = std::min(within, kAboveRounding * norm(minus(place, rest_[corner])));
  }
  return surface_.nearest(place, inside.vertex, within);
}

void SelfContact::find(std::span<const double> positions, double friction, std::vector<Contact>& contacts) {
  search_.find(positions, inside_);
  std::vector<RestSurface::Place> places(inside_.size());
  for_each_chunk(index_size(inside_), kPlacesAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) places[i] = way_out(inside_[i]);
  });
  for (std::size_t i = 0; i < inside_.size();) {
    const Index vertex = inside_[i].vertex;
    std::size_t deepest = i;
    for (; i < inside_.size() && inside_[i].vertex == vertex; ++i) {
      if (places[i].distance > places[deepest].distance) deepest = i;
    }
    const RestSurface::Place& place = places[deepest];
    if (place.triangle == RestSurface::kNone) continue;
    Contact contact;
    if (make_contact(vertex, surface_.triangle(place.triangle), place.weights, friction, positions, contact))
      contacts.push_back(contact);
  }
}

Index SelfContact::vertices_inside(std::span<const double> positions) {
  search_.find(positions, inside_);
  Index count = 0;
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    if (i == 0 || inside_[i].vertex != inside_[i - 1].vertex) ++count;
  }
  return count;
}

std::size_t SelfContact::bytes() const {
  return rest_.capacity() * sizeof(Point) + on_surface_.capacity() / 8 + surface_.bytes() + search_.bytes() +
         inside_.capacity() * sizeof(VertexInside);
}

}  // namespace meshorder
