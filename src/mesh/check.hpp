// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"

#include <vector>

namespace meshorder {

/// Throws InvalidArgument, naming the first fault, unless the mesh is sound: every cell has vertices that
/// exist, coordinates are finite, every array has as many rows as what it belongs to (or rows that exist),
/// members of sets exist, ids and blocks fit. O(size of the mesh).
void check_mesh(const Mesh& mesh);

/// The cells that name a vertex twice, rising. O(vertex entries).
std::vector<Index> degenerate_cells(const Mesh& mesh);

}  // namespace meshorder
