// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/order.hpp>
#include <meshorder/permutation.hpp>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/point.h>
#include <deal.II/base/types.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria_description.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <cstddef>
#include <string_view>
#include <vector>

/// Orders for deal.II: degrees of freedom, and the vertices and cells that a triangulation is made of.
/// Checked with deal.II 9.4.
namespace meshorder {
inline namespace v0_3 {

/// Orders the degrees of freedom by their graph: those that share a cell are neighbours.
///
/// @param dof_handler  after `distribute_dofs`, with all degrees of freedom on this process
/// @param method       name of a vertex method; methods by coordinates use the support points, if the
///                     element has some and all cells have one shape; otherwise these methods are
///                     refused, as for a graph without points
/// @param constraints  as for `make_sparsity_pattern`; a hanging node couples the nodes that it depends on
/// @param options      see `OrderOptions`
/// @return `permutation.old_to_new()` is what `DoFHandler::renumber_dofs` takes
/// @throws as `order_vertices`; dealii::ExcMessage if degrees of freedom are on several processes
template <int dim, int spacedim>
Order order_dofs(const dealii::DoFHandler<dim, spacedim>& dof_handler, std::string_view method = "auto",
                 const dealii::AffineConstraints<double>& constraints = dealii::AffineConstraints<double>(),
                 const OrderOptions& options = {}) {
  const auto count = dof_handler.n_dofs();
  AssertThrow(dof_handler.n_locally_owned_dofs() == count,
              dealii::ExcMessage("meshorder orders degrees of freedom that are all on one process"));
  dealii::DynamicSparsityPattern pattern(count, count);
  dealii::DoFTools::make_sparsity_pattern(dof_handler, pattern, constraints);

  std::vector<Offset> offsets{0};
  std::vector<dealii::types::global_dof_index> neighbours;
  offsets.reserve(count + 1);
  neighbours.reserve(pattern.n_nonzero_elements());
  for (dealii::types::global_dof_index row = 0; row < count; ++row) {
    for (auto entry = pattern.begin(row); entry != pattern.end(row); ++entry) {
      neighbours.push_back(entry->column());
    }
    offsets.push_back(static_cast<Offset>(neighbours.size()));
  }

  std::vector<double> points;
  const auto& shapes = dof_handler.get_triangulation().get_reference_cells();
  if (!dof_handler.has_hp_capabilities() && dof_handler.get_fe().has_support_points() && shapes.size() == 1) {
    std::vector<dealii::Point<spacedim>> support(count);
    const auto& mapping = shapes.front().template get_default_linear_mapping<dim, spacedim>();
    dealii::DoFTools::map_dofs_to_support_points(mapping, dof_handler, support);
    for (const dealii::Point<spacedim>& point : support) {
      for (int axis = 0; axis < spacedim; ++axis) points.push_back(point[static_cast<unsigned int>(axis)]);
    }
  }
  return order_vertices({offsets, neighbours}, method, options,
                        points.empty() ? PointsView{} : PointsView(points, spacedim));
}

/// Renumbers the degrees of freedom in the order of a method: see `order_dofs`. Call it after
/// `distribute_dofs`, before constraints, patterns and vectors are made.
template <int dim, int spacedim>
void renumber_dofs(dealii::DoFHandler<dim, spacedim>& dof_handler, std::string_view method = "auto",
                   const dealii::AffineConstraints<double>& constraints = dealii::AffineConstraints<double>(),
                   const OrderOptions& options = {}) {
  const Order order = order_dofs(dof_handler, method, constraints, options);
  const auto numbers = order.permutation.old_to_new();
  dof_handler.renumber_dofs({numbers.begin(), numbers.end()});
}

/// Orders the vertices and cells that `Triangulation::create_triangulation` takes, in place. Materials,
/// boundary and manifold ids stay with their cells, lines and quads.
///
/// `distribute_dofs` numbers degrees of freedom as it meets them in the cells, so that their order follows
/// that of the cells. Children of refined cells are numbered level after level.
///
/// @param vertices    coordinates
/// @param cells       of one or several shapes
/// @param sub_cells   lines and quads with ids of their own
/// @param methods     names of the methods for vertices and cells
/// @param options     see `OrderOptions`; materials are kept together by `cell_groups`
/// @return what moved: `vertices.permutation.old_to_new()[v]` is the new number of vertex v
/// @throws as `order_mesh`; nothing is changed then
template <int dim, int spacedim>
MeshOrder reorder(std::vector<dealii::Point<spacedim>>& vertices, std::vector<dealii::CellData<dim>>& cells,
                  dealii::SubCellData& sub_cells, const MeshMethods& methods = {},
                  const OrderOptions& options = {}) {
  std::vector<double> points;
  points.reserve(vertices.size() * spacedim);
  for (const dealii::Point<spacedim>& vertex : vertices) {
    for (int axis = 0; axis < spacedim; ++axis) points.push_back(vertex[static_cast<unsigned int>(axis)]);
  }
  std::vector<Offset> offsets{0};
  std::vector<unsigned int> corners;
  for (const dealii::CellData<dim>& cell : cells) {
    corners.insert(corners.end(), cell.vertices.begin(), cell.vertices.end());
    offsets.push_back(static_cast<Offset>(corners.size()));
  }
  MeshOrder order =
      order_mesh({.points = PointsView(points, spacedim), .cells = CellsView::mixed(offsets, corners)},
                 methods, options);

  order.vertices.permutation.move_in_place(vertices);
  order.cells.permutation.move_in_place(cells);
  for (dealii::CellData<dim>& cell : cells) order.vertices.permutation.renumber(cell.vertices);
  for (auto& line : sub_cells.boundary_lines) order.vertices.permutation.renumber(line.vertices);
  for (auto& quad : sub_cells.boundary_quads) order.vertices.permutation.renumber(quad.vertices);
  return order;
}

}  // namespace v0_3
}  // namespace meshorder
