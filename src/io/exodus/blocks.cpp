// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/exodus/exodus.hpp"
#include "io/labels.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

// Divides the cells of a mesh into blocks.

namespace meshorder::exodus {

CellDivision divide(const Mesh& mesh) {
  const auto* const own = dynamic_cast<const ExodusMetadata*>(mesh.format_metadata.get());
  if (own == nullptr) return divide_cells(mesh, {.sets = true});
  // if the file already has 64-bit ids, its kind of netCDF can hold them
  const bool has_wide_labels =
      std::any_of(own->blocks.begin(), own->blocks.end(),
                  [](const BlockRecord& block) { return !std::in_range<std::int32_t>(block.label); });
  return divide_cells(mesh, {.wide_labels = has_wide_labels});
}

SideNodes::SideNodes(const Mesh& mesh, const ExodusMetadata& metadata)
    : mesh_(mesh), labels_(labels_of(mesh, Association::cells).values) {
  for (const BlockRecord& block : metadata.blocks) {
    if (block.nodes > 0) types_.try_emplace({block.label, block.shape, block.nodes}, block.type);
  }
}

int SideNodes::count(Index cell, int side) const {
  const Shape shape = mesh_.cells.shapes[cell];
  const int nodes = mesh_.cells.vertex_count(cell);
  const auto type = types_.find({labels_.empty() ? 0 : labels_[cell], shape, nodes});
  const int faces =
      faces_of(shape, type == types_.end() ? type_of(shape, nodes) : type->second, mesh_.dimension);
  return nodes_of_side(shape, nodes, side, faces);
}

Permutation places(const Mesh& mesh, std::vector<Index>& blocks) {
  return places_by_division(divide(mesh), blocks);
}

}  // namespace meshorder::exodus
