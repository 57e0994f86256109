// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder {

/// Simplices of one dimension D, each on D + 1 vertices: lines, triangles or tetrahedra.
struct Simplices {
  int dimension = 0;            ///< 0 if there are none
  std::vector<Index> vertices;  ///< simplex s has `vertices[(D + 1) s] … vertices[(D + 1) s + D]`
  std::vector<Index> cells;     ///< the cell that each was cut out of

  [[nodiscard]] Offset size() const noexcept {
    return static_cast<Offset>(vertices.size()) / (dimension + 1);
  }
};

/// Cuts the mesh's elements, in their order, into simplices on their corners: a hexahedron into six
/// tetrahedra, a wedge into three, a pyramid into two, a polygon into a fan of triangles. Ignores mid-side
/// nodes and cells of lower dimension. A polyhedron, whose faces are not known, becomes a chain of
/// tetrahedra, each on four successive corners: they touch what its cut would touch, but do not fill it. The
/// pieces of a cell depend on the order of its corners alone, so that reordering the mesh reorders the
/// simplices and changes none. O(cells).
Simplices cut_into_simplices(const Mesh& mesh);

}  // namespace meshorder
