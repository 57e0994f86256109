// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Reordering a mesh for the format that it will be written in.
#include "mesh/reorder.hpp"

#include "base/call.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"

#include <utility>

namespace meshorder {

Permutation arrange_cells(Mesh& mesh, const Format& to) {
  if (mesh.format == to.key()) return Permutation::identity(mesh.cell_count());
  mesh.cell_blocks.clear();
  return to.groups_cells_by_type ? group_cells_by_type(mesh) : Permutation::identity(mesh.cell_count());
}

MeshOrder reorder(Mesh& mesh, const ReorderOptions& options, CsrGraph& graph) {
  return in_call(options.order.run, [&] {
    if (options.order.check != Check::none) check_mesh(mesh);
    const std::vector<Index> blocks = mesh.cell_blocks;
    const Permutation arranged = options.format.empty() ? Permutation::identity(mesh.cell_count())
                                                        : arrange_cells(mesh, format_named(options.format));
    try {
      graph = vertex_graph(mesh);
      MeshOrder order = compute_reordering(mesh, graph, options);
      apply_reordering(mesh, order, options.ids);
      order.cells.permutation = arranged.then(order.cells.permutation);
      return order;
    } catch (...) {
      restore_cells(mesh, arranged, blocks);
      throw;
    }
  });
}

inline namespace v0_2 {

MeshOrder reorder(Mesh& mesh, const ReorderOptions& options) {
  CsrGraph graph;
  return reorder(mesh, options, graph);
}

}  // namespace v0_2
}  // namespace meshorder
