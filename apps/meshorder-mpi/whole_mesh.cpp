// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "whole_mesh.hpp"

#include "distributed/order/partition.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include "ordering/order_cells.hpp"
#include "payoff/quantities.hpp"

#include <vector>

namespace meshorder::command {
namespace {

using distributed::Communicator;
using distributed::GlobalIndex;

/// Number of cells above which a warning on the memory of rank 0 is due.
constexpr Index kManyCells = 10'000'000;

std::vector<Index> narrowed(const std::vector<GlobalIndex>& numbers) {
  return {numbers.begin(), numbers.end()};
}

/// Fills in the part of each vertex and of each cell of a mesh in its new order.
void note_parts(const Mesh& mesh, const std::vector<GlobalIndex>& starts, Maps& maps) {
  maps.vertex_parts.reserve(mesh.points.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    maps.vertex_parts.push_back(distributed::part_of(v, starts));
  maps.cell_parts.reserve(mesh.cells.shapes.size());
  for (Index c = 0; c < mesh.cell_count(); ++c)
    maps.cell_parts.push_back(distributed::part_of_cell(mesh.cells[c], starts));
}

}  // namespace

MeshToOrder read_at_root(const Communicator& communicator, const MeshFiles& files, Ids ids, Notes& notes) {
  return communicator.at_root([&] {
    check_holds_ids(output_format_of(files.output), ids);
    MeshToOrder whole = read_to_order(files, notes);
    if (whole.mesh.cell_count() > kManyCells) {
      notes.push_back(with_commas(whole.mesh.cell_count()) +
                      " cells are read and written by rank 0, which needs memory for all of them");
    }
    whole.arranged = arrange_cells(whole.mesh, *whole.format);
    return whole;
  });
}

void move_at_root(const Communicator& communicator, MeshToOrder& whole,
                  const distributed::DistributedOrder& order, bool has_maps, Ids ids) {
  const std::vector<GlobalIndex> vertices = communicator.gathered_at_root(order.new_vertices);
  const std::vector<GlobalIndex> cells = communicator.gathered_at_root(order.cells);
  communicator.at_root([&] {
    whole.maps.vertices = Permutation::from_old_to_new(narrowed(vertices));
    Permutation places =
        stored_matrix(whole.mesh) != nullptr
            ? Permutation::identity(whole.mesh.cell_count())
            : with_groups_together(
                  whole.mesh,
                  permutation_within_classes(slot_classes(cell_arrays(whole.mesh)), narrowed(cells)),
                  *whole.format);
    whole.maps.cells =
        move_in_file(whole.mesh, whole.maps.vertices, std::move(places), whole.format, whole.arranged, ids);
    if (has_maps) note_parts(whole.mesh, order.report.part_starts, whole.maps);
  });
}

}  // namespace meshorder::command
