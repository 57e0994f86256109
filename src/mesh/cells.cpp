// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/cells.hpp"

#include <algorithm>

namespace meshorder {

void Cells::push_back(Shape shape, std::span<const Index> cell_vertices) {
  shapes.push_back(shape);
  vertices.insert(vertices.end(), cell_vertices.begin(), cell_vertices.end());
  offsets.push_back(static_cast<Offset>(vertices.size()));
}

void Cells::reserve(Offset cells, Offset vertex_entries) {
  shapes.reserve(cells);
  offsets.reserve(cells + 1);
  vertices.reserve(vertex_entries);
}

int Cells::highest_dimension() const {
  int highest = -1;
  for (int shape = 0; shape < kShapes; ++shape) {
    const auto s = static_cast<Shape>(shape);
    if (dimension(s) > highest && std::find(shapes.begin(), shapes.end(), s) != shapes.end()) {
      highest = dimension(s);
    }
  }
  return highest;
}

}  // namespace meshorder
