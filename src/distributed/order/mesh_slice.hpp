// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder::distributed {

/// A rank's part of a mesh: a range of the vertices and a range of the cells, by their numbers in the file.
struct MeshSlice {
  Layout vertices;
  Layout cells;
  std::vector<Point> points;  ///< coordinates of this rank's vertices
  Rows cell_vertices;         ///< global numbers of the vertices of this rank's cells
  std::vector<Shape> shapes;  ///< shapes of this rank's cells
};

/// Distributes the points and cells of the root's mesh. Every rank has to call it. O(size of the mesh) at the
/// root.
///
/// @param mesh  the mesh at the root; ignored on other ranks
/// @throws as `Communicator::exchange`
[[nodiscard]] MeshSlice scattered(const Communicator& communicator, const Mesh& mesh);

/// Returns for each cell whether its dimension is the highest of all ranks' cells. Every rank has to call it.
[[nodiscard]] std::vector<char> are_elements(const Communicator& communicator,
                                             const std::vector<Shape>& shapes);

}  // namespace meshorder::distributed
