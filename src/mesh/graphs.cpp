// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"

#include "mesh/boundary.hpp"

#include <algorithm>
#include <numeric>

namespace meshorder {
namespace {

template <class Wanted>
CellIncidence cells_that(const Mesh& mesh, Wanted wanted) {
  CellIncidence result;
  result.incidence.vertex_count = mesh.vertex_count();
  const std::vector<Shape>& shapes = mesh.cells.shapes;
  if (std::all_of(shapes.begin(), shapes.end(), wanted)) {
    result.cells.resize(shapes.size());
    std::iota(result.cells.begin(), result.cells.end(), Index{0});
    result.incidence.offsets = mesh.cells.offsets;
    result.incidence.vertices = mesh.cells.vertices;
    return result;
  }
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (!wanted(shapes[c])) continue;
    result.cells.push_back(c);
    const auto vertices = mesh.cells[c];
    result.incidence.vertices.insert(result.incidence.vertices.end(), vertices.begin(), vertices.end());
    result.incidence.offsets.push_back(static_cast<Offset>(result.incidence.vertices.size()));
  }
  return result;
}

}  // namespace

CellIncidence elements(const Mesh& mesh) {
  const int highest = mesh.cells.highest_dimension();
  return cells_that(mesh, [&](Shape shape) { return dimension(shape) == highest; });
}

CellIncidence lower_dimensional_cells(const Mesh& mesh) {
  const int highest = mesh.cells.highest_dimension();
  return cells_that(mesh, [&](Shape shape) { return dimension(shape) < highest; });
}

CsrGraph vertex_graph(const Mesh& mesh) { return vertex_graph(elements(mesh).incidence); }

CsrGraph facet_graph(const Mesh& mesh) {
  const std::vector<ElementFacet> facets = matched_facets(mesh);
  std::vector<Edge> joins;
  for (std::size_t i = 1; i < facets.size(); ++i) {
    // a facet of more than two elements joins each to the next, which keeps them together
    if (facets[i - 1].corners == facets[i].corners)
      joins.push_back({facets[i - 1].element, facets[i].element});
  }
  const int highest = mesh.cells.highest_dimension();
  const auto count = std::count_if(mesh.cells.shapes.begin(), mesh.cells.shapes.end(),
                                   [&](Shape shape) { return dimension(shape) == highest; });
  return graph_from_edges(static_cast<Index>(count), joins);
}

}  // namespace meshorder
