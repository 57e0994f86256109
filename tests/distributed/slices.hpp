// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/order/global_graph.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "distributed/order/order.hpp"
#include "graph/csr_graph.hpp"
#include "mesh/graphs.hpp"
#include "ordering/order_cells.hpp"
#include <meshorder/permutation.hpp>

#include <vector>

namespace meshorder::test {

/// The elements of a slice, with `shift` added to their vertices' numbers.
inline distributed::Rows elements_of(const distributed::Communicator& communicator,
                                     const distributed::MeshSlice& slice,
                                     distributed::GlobalIndex shift = 0) {
  const std::vector<char> is_element = are_elements(communicator, slice.shapes);
  distributed::Rows elements;
  for (Offset c = 0; c < slice.cell_vertices.size(); ++c) {
    if (is_element[static_cast<std::size_t>(c)] == 0) continue;
    for (const distributed::GlobalIndex vertex : slice.cell_vertices[c])
      elements.entries.push_back(vertex + shift);
    elements.end_row();
  }
  return elements;
}

/// The graph of a mesh, numbered as in the file.
inline distributed::GlobalGraph graph_in_file(const distributed::Communicator& communicator,
                                              const Mesh& mesh) {
  const distributed::MeshSlice slice = scattered(communicator, mesh);
  return global_graph(communicator, slice.vertices, elements_of(communicator, slice));
}

/// The order of a mesh that the ranks found together, on each of them.
struct WholeOrder {
  Permutation vertices;
  Permutation cells;
  distributed::DistributedReport report;
};

inline WholeOrder ordered(const distributed::Communicator& communicator, const Mesh& mesh,
                          const distributed::DistributedOptions& options) {
  const distributed::DistributedOrder order =
      order_slices(communicator, scattered(communicator, mesh), options);
  const auto everywhere = [&](const std::vector<distributed::GlobalIndex>& own) {
    const std::vector<distributed::GlobalIndex> all =
        communicator.broadcast(communicator.gathered_at_root(own));
    return std::vector<Index>(all.begin(), all.end());
  };
  return {Permutation::from_old_to_new(everywhere(order.new_vertices)),
          permutation_within_classes(slot_classes(cell_arrays(mesh)), everywhere(order.cells)), order.report};
}

/// A path of lines whose k-th vertex has the number k · step mod n.
inline Mesh path(Index n, Index step) {
  Mesh mesh;
  const auto number = [&](Index k) { return static_cast<Index>(Offset{k} * step % n); };
  mesh.points.resize(static_cast<std::size_t>(n));
  for (Index k = 0; k < n; ++k) mesh.points[static_cast<std::size_t>(number(k))] = {1.0 * k, 0, 0};
  for (Index k = 1; k < n; ++k)
    mesh.cells.push_back(Shape::line, std::vector<Index>{number(k - 1), number(k)});
  return mesh;
}

}  // namespace meshorder::test
