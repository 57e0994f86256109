// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/mesh_slice.hpp"

#include <algorithm>
#include <cstddef>

namespace meshorder::distributed {
MeshSlice scattered(const Communicator& communicator, const Mesh& mesh) {
  const std::vector<GlobalIndex> counts =
      communicator.broadcast(std::vector<GlobalIndex>{mesh.vertex_count(), mesh.cell_count()});
  MeshSlice slice;
  slice.vertices = Layout::even(counts[0], communicator.size());
  slice.cells = Layout::even(counts[1], communicator.size());
  slice.points = communicator.scattered_from_root(mesh.points, slice.vertices.starts());
  const std::vector<Offset>& cell_starts = slice.cells.starts();
  slice.shapes = communicator.scattered_from_root(mesh.cells.shapes, cell_starts);

  // where this rank's rows begin in the root's array; the offsets below are relative to the first row
  const std::vector<Offset> begins = communicator.scattered_from_root(mesh.cells.offsets, cell_starts);
  std::vector<Offset> vertex_starts(cell_starts.size(), 0);
  if (communicator.is_root()) {
    std::transform(cell_starts.begin(), cell_starts.end(), vertex_starts.begin(),
                   [&](Offset cell) { return mesh.cells.offsets[static_cast<std::size_t>(cell)]; });
  }
  const std::vector<Index> vertices = communicator.scattered_from_root(mesh.cells.vertices, vertex_starts);
  communicator.together([&] {
    slice.cell_vertices.entries.assign(vertices.begin(), vertices.end());
    std::vector<Offset>& offsets = slice.cell_vertices.offsets;
    offsets.clear();
    offsets.reserve(begins.size() + 1);
    for (const Offset begin : begins) offsets.push_back(begin - begins.front());
    offsets.push_back(static_cast<Offset>(vertices.size()));
  });
  return slice;
}

std::vector<char> are_elements(const Communicator& communicator, const std::vector<Shape>& shapes) {
  int highest = -1;
  for (const Shape shape : shapes) highest = std::max(highest, dimension(shape));
  for (const int other : communicator.gathered(highest)) highest = std::max(highest, other);
  return communicator.together([&] {
    std::vector<char> result(shapes.size());
    std::transform(shapes.begin(), shapes.end(), result.begin(),
                   [&](Shape shape) { return dimension(shape) == highest; });
    return result;
  });
}

}  // namespace meshorder::distributed
