// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/exodus/exodus.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

// The blocks that the cells of a mesh are divided into.

namespace meshorder::exodus {

CellDivision divide(const Mesh& mesh) {
  const auto* const own = dynamic_cast<const Metadata*>(mesh.format_metadata.get());
  if (own == nullptr) return divide_cells(mesh, {.sets = true});
  // a file with ids of 64 bits is of a kind that holds them
  const bool has_wide_labels =
      std::any_of(own->blocks.begin(), own->blocks.end(),
                  [](const BlockRecord& block) { return !std::in_range<std::int32_t>(block.label); });
  return divide_cells(mesh, {.wide_labels = has_wide_labels});
}

Permutation places(const Mesh& mesh, std::vector<Index>& blocks) {
  return places_by_division(divide(mesh), blocks);
}

}  // namespace meshorder::exodus
