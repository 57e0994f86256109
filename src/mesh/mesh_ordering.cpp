// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/mesh_ordering.hpp"

#include "base/stopwatch.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "ordering/grouped.hpp"

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {

/// All cells in their new order: elements by their method, then the others by lexmax.
std::vector<Index> cells_in_order(const Mesh& mesh, const ReorderingOptions& options, Reordering& result) {
  const CellIncidence top = elements(mesh);
  const auto facets_of_mesh = [&] { return facet_graph(mesh); };
  Ordering by_method = order_elements(
      options.elements, {top.incidence, result.vertices, mesh.points, facets_of_mesh}, options.ordering);
  result.element_fiedler = std::move(by_method.fiedler);
  result.element_method = std::move(by_method.method);

  std::vector<Index> order;
  order.reserve(mesh.cells.shapes.size());
  for (const Index e : by_method.permutation.new_to_old()) order.push_back(top.cells[e]);
  const CellIncidence lower = lower_dimensional_cells(mesh);
  const std::string_view lower_method = options.elements == "original" ? "original" : "lexmax";
  const Ordering of_lower = order_elements(
      lower_method, {lower.incidence, result.vertices, mesh.points, facets_of_mesh}, options.ordering);
  for (const Index e : of_lower.permutation.new_to_old()) order.push_back(lower.cells[e]);
  if (result.groups && result.groups->association == Association::cells) {
    const std::vector<Index>& group_of = result.groups->of_cells;
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return group_of[a] < group_of[b]; });
  }
  return order;
}

}  // namespace

Reordering compute_reordering(const Mesh& mesh, const CsrGraph& graph, const ReorderingOptions& options) {
  Reordering result;
  const Stopwatch vertices;
  if (!options.group_by.empty()) result.groups = grouping_by(mesh, options.group_by);
  Ordering by_method =
      result.groups
          ? order_vertices_in_groups(options.vertices, {graph, mesh.points}, result.groups->of_vertices,
                                     result.groups->count(), options.ordering)
          : order_vertices(options.vertices, {graph, mesh.points}, options.ordering);
  result.vertices = std::move(by_method.permutation);
  result.vertex_fiedler = std::move(by_method.fiedler);
  result.vertex_method = std::move(by_method.method);
  result.vertex_seconds = vertices.seconds();

  const Stopwatch cells;
  result.cells = permutation_within_blocks(mesh, cells_in_order(mesh, options, result));
  result.element_seconds = cells.seconds();
  return result;
}

Reordering reorder(Mesh& mesh, const ReorderingOptions& options) {
  Reordering result = compute_reordering(mesh, vertex_graph(mesh), options);
  apply_reordering(mesh, result.vertices, result.cells);
  return result;
}

}  // namespace meshorder
