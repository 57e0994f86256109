// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "mesh/mesh.hpp"
#include "ordering/permutation.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// The outer surface of a body as triangles over some of its vertices, few enough to be shown.
struct SurfaceView {
  std::vector<Index> vertices;                  ///< of the mesh, by their numbers there, as first used
  std::vector<std::array<Index, 3>> triangles;  ///< entries of `vertices`, seen from outside anticlockwise
};

/// The mesh's outer_triangles, simplified to about `most_triangles` where they are more (Garland and Heckbert
/// 1997, by meshoptimizer). All vertices are vertices of the mesh, so that what is known of those is known of
/// the view's. The topology stays unless that would leave more than twice as many. The same on every run.
/// Throws Error for a mesh without volumes and surface. O(n log n).
SurfaceView surface_view(const Mesh& mesh, Index most_triangles);

/// How many entries of a matrix with the pattern of the mesh's vertex graph, its diagonal among them, lie in
/// each tile of a picture of side × side tiles, rows from the top.
struct SparsityPattern {
  int side = 0;
  std::vector<std::uint32_t> counts;
};

/// In the given order; `side` becomes smaller where there are fewer vertices. O(edges).
SparsityPattern sparsity_pattern(const CsrGraph& graph, const Permutation& order, int side);

}  // namespace meshorder
