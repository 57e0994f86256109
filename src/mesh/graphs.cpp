// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"

#include "cells/facets.hpp"
#include "cells/vertex_joins.hpp"

namespace meshorder {

CellArrays cell_arrays(const Mesh& mesh) {
  CellArrays arrays;
  arrays.vertex_count = mesh.vertex_count();
  arrays.offsets = mesh.cells.offsets;
  arrays.vertices = mesh.cells.vertices;
  arrays.shapes = mesh.cells.shapes;
  arrays.block_starts = mesh.cell_blocks;
  return arrays;
}

CsrGraph vertex_graph(const Mesh& mesh) { return vertex_graph(cell_arrays(mesh)); }

CsrGraph facet_graph(const Mesh& mesh) {
  const CellArrays cells = cell_arrays(mesh);
  return joined_by_facet(cells, CellSelection::elements(cells));
}

}  // namespace meshorder
