// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/page/page.hpp"
#include "lab/scenario/motion_file.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {

/// Returns the mesh's `boundary_triangles`, simplified to about `most_triangles` if there are more (Garland
/// and Heckbert 1997, Surface simplification using quadric error metrics; by meshoptimizer). All vertices are
/// vertices of the mesh. Keeps the topology unless more than 2 · `most_triangles` would remain. The result is
/// the same on every run. Throws Error for a mesh without volume cells and surface. O(n log n).
SurfaceView surface_view(const Mesh& mesh, Index most_triangles);

/// How much of meshes and motions a page shows.
struct PageDetail {
  Index mesh_triangles = 90'000;  ///< approximate number for a mesh coloured by order
  Index motion_triangles = 12'000;
  Index frames = 60;  ///< most frames of a motion
  int sparsity_side = 192;
};

/// Returns a mesh for the page. `orders` are pairs of an ordering's name and the mesh's vertex order. Throws
/// Error for a mesh without a surface.
PageMesh page_mesh(const std::string& name, const Mesh& mesh,
                   const std::vector<std::pair<std::string, Permutation>>& orders,
                   const PageDetail& detail = {});

/// The triangles of a fluid's surface in each frame; empty for a body.
using FluidSurfaces = std::vector<std::vector<std::array<Index, 3>>>;

/// Returns the motion of a scenario on the mesh's simplified surface, with as many frames as `detail` allows,
/// evenly spread, first and last included. `obstacles` may be nullptr. Throws InvalidArgument if the motion
/// differs from the mesh in its number of vertices, or from `frame_steps` in its number of frames.
PageMotion page_motion(const ScenarioRecord& scenario, const Mesh& mesh, const Motion& motion,
                       const FluidSurfaces& surfaces, const Mesh* obstacles, const PageDetail& detail = {});

}  // namespace meshorder
