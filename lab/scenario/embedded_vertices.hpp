// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/simplices.hpp"
#include "lab/motion/integrator.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// A vertex that is not a corner of a tetrahedron, and the tetrahedron with which the vertex moves. The
/// vertex's rest position is the weighted mean of the corners; the weights add up to 1.
struct EmbeddedVertex {
  Index vertex = 0;
  std::array<Index, 4> corners{};
  std::array<double, 4> weights{};
};

/// Embeds the nodes on edges, on faces and inside volume cells. Each node is embedded in the tetrahedron of
/// its cells in which its least weight is greatest; the first of equals. `simplices` are the mesh's
/// tetrahedra. Vertices that belong to no volume cell, or only to flat volume cells, are not embedded.
/// O(tetrahedra · nodes of a cell).
std::vector<EmbeddedVertex> embed_vertices(const Mesh& mesh, const Simplices& simplices);

/// Computes positions and velocities of embedded vertices from the corners of their tetrahedra. `rest` are
/// the positions of all vertices at rest. O(embedded vertices).
void move_embedded(const std::vector<EmbeddedVertex>& embedded, std::span<const Point> rest,
                   MotionState& state);

}  // namespace meshorder
