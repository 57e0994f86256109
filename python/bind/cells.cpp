// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells.hpp"

#include <meshorder/error.hpp>

#include <cstdint>
#include <span>

namespace meshorder::python {
namespace {

Shape parse_shape(const std::string& name) {
  for (int s = 0; s < kShapes; ++s) {
    if (to_string(static_cast<Shape>(s)) == name) return static_cast<Shape>(s);
  }
  throw InvalidArgument("cells: unknown shape '" + name + "'");
}

CellsView cells_view(const Blocks& given) {
  std::vector<CellBlock> blocks;
  for (const auto& [shape, vertices] : given) {
    if (vertices.ndim() != 2) throw InvalidArgument("cells: expected a row of vertices for each cell");
    blocks.push_back({parse_shape(shape), static_cast<int>(vertices.shape(1)), index_view(vertices)});
  }
  return CellsView::blocks(blocks);
}

CellsView cells_view(const Mixed& given) {
  const auto& [offsets, vertices, types] = given;
  std::span<const std::uint8_t> vtk_types;
  if (types) vtk_types = {static_cast<const std::uint8_t*>(types->data()), types->size()};
  return CellsView::mixed(index_view(offsets), index_view(vertices), vtk_types);
}

}  // namespace

MeshView mesh_view(const GivenPoints& points, const GivenCells& cells, std::size_t vertex_count) {
  return {.points = points ? points_view(*points) : PointsView(),
          .cells = std::visit([](const auto& given) { return cells_view(given); }, cells),
          .vertex_count = vertex_count};
}

}  // namespace meshorder::python
