// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/graph/csr_graph.hpp>
#include <meshorder/mesh/mesh.hpp>
#include <meshorder/ordering/permutation.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// The outer surface of a body as triangles over some of its vertices, few enough to be shown.
struct SurfaceView {
  std::vector<Index> vertices;                  ///< of the mesh, by their numbers there
  std::vector<std::array<Index, 3>> triangles;  ///< entries of `vertices`, seen from outside anticlockwise
};

/// The faces that belong to one volume cell alone, simplified to about `most_triangles` where they are more.
/// All vertices are vertices of the mesh, so that what is known of those is known of the view's. Of a surface
/// mesh its triangles. Throws Error for a mesh without either.
SurfaceView surface_view(const Mesh& mesh, Index most_triangles);

/// How many entries of a matrix with the pattern of the mesh's vertex graph lie in each tile of a picture of
/// side × side tiles, rows from the top, in the given order.
struct SparsityPattern {
  int side = 0;
  std::vector<std::uint32_t> counts;
};
SparsityPattern sparsity_pattern(const CsrGraph& graph, const Permutation& order, int side);

}  // namespace meshorder
