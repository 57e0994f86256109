// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <array>
#include <vector>

namespace meshorder {

/// The simplified outer surface of a body.
struct SurfaceView {
  std::vector<Index> vertices;  ///< vertices of the mesh, in the sequence of their first use
  std::vector<std::array<Index, 3>>
      triangles;  ///< indices into `vertices`, anticlockwise as seen from outside
};

/// Returns the mesh's `boundary_triangles`, simplified to about `most_triangles` if there are more (Garland
/// and Heckbert 1997, Surface simplification using quadric error metrics; by meshoptimizer). All vertices are
/// vertices of the mesh. Keeps the topology unless that would leave more than twice as many triangles. The
/// result is the same on every run. Throws Error for a mesh without volume cells and surface. O(n log n).
SurfaceView surface_view(const Mesh& mesh, Index most_triangles);

}  // namespace meshorder
