// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder::distributed {

/// What a rank holds of a mesh before anything is known of it: vertices and cells in ranges of their numbers
/// in the file. What a reader of slices gives, too.
struct MeshSlice {
  Layout vertices;
  Layout cells;
  std::vector<Point> points;  ///< of the own vertices
  Rows cell_vertices;         ///< of the own cells, by their numbers among all
  std::vector<Shape> shapes;  ///< of the own cells
};

/// Shares out the points and cells of a mesh that the root has read. Every rank has to call it. O(size of the
/// mesh) at the root.
///
/// @param mesh  at the root; not looked at elsewhere
/// @throws as `Communicator::exchange`
[[nodiscard]] MeshSlice scattered(const Communicator& communicator, const Mesh& mesh);

/// Returns whether cells are elements: of the highest dimension that any rank has. Every rank has to call it.
[[nodiscard]] std::vector<char> are_elements(const Communicator& communicator,
                                             const std::vector<Shape>& shapes);

}  // namespace meshorder::distributed
