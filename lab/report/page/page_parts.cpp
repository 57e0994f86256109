// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/page_parts.hpp"

#include "mesh/graphs.hpp"
#include "mesh/stored_matrix.hpp"
#include "metrics/measures.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

namespace meshorder {
namespace {

std::vector<Point> points_of(const SurfaceView& surface, const Mesh& mesh) {
  std::vector<Point> points;
  points.reserve(surface.vertices.size());
  for (const Index v : surface.vertices) points.push_back(mesh.points[v]);
  return points;
}

/// Returns at most `most` frames, spread evenly, first and last included.
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
