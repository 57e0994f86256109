// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/page_parts.hpp"

#include "lab/scenario/vertex_choice.hpp"
#include "mesh/graphs.hpp"
#include "mesh/simplices.hpp"
#include "mesh/stored_matrix.hpp"
#include "metrics/measures.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

namespace meshorder {
namespace {

constexpr float kAnyError = std::numeric_limits<float>::max();
/// The topology may change if keeping it would leave more than this many times the requested number of
/// triangles.
constexpr std::size_t kTooMany = 2;

/// Returns coordinates for the simplifier, relative to the box, so that floats do not lose digits to offsets.
std::vector<float> coordinates(const Mesh& mesh, const std::vector<Index>& vertices) {
  const BoundingBox box = bounding_box(mesh.points, vertices);
  const double longest = std::max(box.longest_side(), std::numeric_limits<double>::min());
  std::vector<float> result;
  result.reserve(3 * vertices.size());
  for (const Index v : vertices) {
    for (std::size_t c = 0; c < 3; ++c)
      result.push_back(static_cast<float>((mesh.points[v][c] - box.low[c]) / longest));
  }
  return result;
}

/// Returns fewer triangles, whose corners are among `corners`.
std::vector<unsigned> simplified(const std::vector<unsigned>& corners, const std::vector<float>& places,
                                 std::size_t most_corners) {
  std::vector<unsigned> result(corners.size());
  constexpr std::size_t kStride = 3 * sizeof(float);
  const std::size_t vertices = places.size() / 3;
  std::size_t left = meshopt_simplify(result.data(), corners.data(), corners.size(), places.data(), vertices,
                                      kStride, most_corners, kAnyError);
  if (left > kTooMany * most_corners) {
    left = meshopt_simplifySloppy(result.data(), corners.data(), corners.size(), places.data(), vertices,
                                  kStride, most_corners, kAnyError);
  }
  result.resize(left);
  return result;
}

/// Puts neighbours together, for a graphics card's cache and for the compression of the numbers.
void order_for_drawing(std::vector<unsigned>& corners, std::vector<Index>& vertices) {
  meshopt_optimizeVertexCache(corners.data(), corners.data(), corners.size(), vertices.size());
  std::vector<unsigned> places(vertices.size());
  const std::size_t used =
      meshopt_optimizeVertexFetchRemap(places.data(), corners.data(), corners.size(), vertices.size());
  std::vector<Index> kept(used);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (places[v] < used) kept[places[v]] = vertices[v];
  }
  for (unsigned& corner : corners) corner = places[corner];
  vertices = std::move(kept);
}

std::vector<Point> points_of(const SurfaceView& surface, const Mesh& mesh) {
  std::vector<Point> points;
  points.reserve(surface.vertices.size());
  for (const Index v : surface.vertices) points.push_back(mesh.points[v]);
  return points;
}

/// Returns the indices of at most max(`most`, 2) frames, spread evenly, first and last included.
std::vector<std::size_t> shown_frames(std::size_t frames, std::size_t most) {
  std::vector<std::size_t> shown;
  const std::size_t count = std::min(frames, std::max<std::size_t>(most, 2));
  for (std::size_t k = 0; k < count; ++k) shown.push_back(count == 1 ? 0 : k * (frames - 1) / (count - 1));
  return shown;
}

/// Returns the surface of a fluid, simplified.
template <class Place>
SurfaceView fluid_surface(const std::vector<std::array<Index, 3>>& triangles, Index vertices,
                          const Place& place, Index most_triangles) {
  Mesh mesh;
  for (Index v = 0; v < vertices; ++v) mesh.points.push_back(place(v));
  for (const std::array<Index, 3>& triangle : triangles) mesh.cells.push_back(Shape::triangle, triangle);
  return triangles.empty() ? SurfaceView{} : surface_view(mesh, most_triangles);
}

}  // namespace

SurfaceView surface_view(const Mesh& mesh, Index most_triangles) {
  const std::vector<std::array<Index, 3>> triangles = boundary_triangles(mesh);
  SurfaceView view;
  std::vector<unsigned> corners;
  std::vector<Index> numbers(mesh.points.size(), -1);  // each mesh vertex's number in the view
  for (const auto& triangle : triangles) {
    for (const Index v : triangle) {
      if (numbers[v] < 0) {
        numbers[v] = index_size(view.vertices);
        view.vertices.push_back(v);
      }
      corners.push_back(static_cast<unsigned>(numbers[v]));
    }
  }
  const auto most_corners = 3 * static_cast<std::size_t>(std::max(most_triangles, Index{1}));
  if (corners.size() > most_corners)
    corners = simplified(corners, coordinates(mesh, view.vertices), most_corners);
  order_for_drawing(corners, view.vertices);
  view.triangles.reserve(corners.size() / 3);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    view.triangles.push_back({static_cast<Index>(corners[i]), static_cast<Index>(corners[i + 1]),
                              static_cast<Index>(corners[i + 2])});
  }
  return view;
}

PageMesh page_mesh(const std::string& name, const Mesh& mesh,
                   const std::vector<std::pair<std::string, Permutation>>& orders, const PageDetail& detail) {
  PageMesh result;
  result.name = name;
  // for a matrix the page shows only patterns
  if (stored_matrix(mesh) == nullptr) result.surface = surface_view(mesh, detail.mesh_triangles);
  result.points = points_of(result.surface, mesh);
  const CsrGraph graph = vertex_graph(mesh);
  for (const auto& [ordering, order] : orders) {
    PageMesh::Order shown{ordering, {}, pattern_of(graph, order, detail.sparsity_side)};
    for (const Index v : result.surface.vertices) shown.ranks.push_back(order.old_to_new()[v]);
    result.orders.push_back(std::move(shown));
  }
  return result;
}

PageMotion page_motion(const ScenarioRecord& scenario, const Mesh& mesh, const Motion& motion,
                       const FluidSurfaces& surfaces, const Mesh* obstacles, const PageDetail& detail) {
  if (motion.vertices != mesh.vertex_count()) {
    throw InvalidArgument(
        fmt::format("a motion of {} vertices for a mesh of {}", motion.vertices, mesh.vertex_count()));
  }
  if (motion.frames.size() != scenario.frame_steps.size()) {
    throw InvalidArgument(fmt::format("a motion of {} frames where {} were kept", motion.frames.size(),
                                      scenario.frame_steps.size()));
  }
  PageMotion result;
  result.scenario = scenario.name;
  if (surfaces.empty()) result.surface = surface_view(mesh, detail.motion_triangles);
  for (const std::size_t f : shown_frames(motion.frames.size(), detail.frames)) {
    result.steps.push_back(scenario.frame_steps[f]);
    const auto place = [&](Index v) {
      const auto& [x, y, z] = motion.frames[f][v];
      return Point{x, y, z};
    };
    if (!surfaces.empty())
      result.surfaces.push_back(
          fluid_surface(surfaces[f], motion.vertices, place, detail.motion_triangles / 2));
    const SurfaceView& surface = surfaces.empty() ? result.surface : result.surfaces.back();
    std::vector<Point>& frame = result.frames.emplace_back();
    frame.reserve(surface.vertices.size());
    for (const Index v : surface.vertices) frame.push_back(place(v));
  }
  if (obstacles != nullptr) {
    result.obstacle = surface_view(*obstacles, detail.motion_triangles);
    result.obstacle_points = points_of(result.obstacle, *obstacles);
  }
  return result;
}

}  // namespace meshorder
