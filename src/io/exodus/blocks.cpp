// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/exodus/exodus.hpp"

// The blocks that the cells of a mesh are divided into.

namespace meshorder::exodus {

CellDivision divide(const Mesh& mesh) {
  return divide_cells(mesh, dynamic_cast<const Metadata*>(mesh.format_metadata.get()) == nullptr);
}

Permutation places(const Mesh& mesh, std::vector<Index>& blocks) {
  return places_by_division(divide(mesh), blocks);
}

}  // namespace meshorder::exodus
