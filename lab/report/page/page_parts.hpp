// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/page/page.hpp"
#include "lab/scenario/motion_file.hpp"

#include <string>
#include <utility>
#include <vector>

namespace meshorder {

/// How much of a mesh a page shows.
struct PageDetail {
  Index mesh_triangles = 90'000;  ///< about; of the meshes coloured by their orders
  Index motion_triangles = 12'000;
  Index frames = 60;  ///< at most, of a motion
  int sparsity_side = 192;
};

/// A mesh as the page shows it, in each of its vertex orders, which are named as the study's orderings.
/// Throws Error for a mesh without surface.
PageMesh page_mesh(const std::string& name, const Mesh& mesh,
                   const std::vector<std::pair<std::string, Permutation>>& orders,
                   const PageDetail& detail = {});

/// The motion of a scenario on the mesh's simplified surface, every frame of it or every second … as many as
/// `detail` allows, the last one always. `obstacles` is nullptr where there are none. Throws InvalidArgument
/// when the motion has another number of vertices than the mesh, or of frames than `frame_steps`.
PageMotion page_motion(const ScenarioRecord& scenario, const Mesh& mesh, const Motion& motion,
                       const Mesh* obstacles, const PageDetail& detail = {});

}  // namespace meshorder
