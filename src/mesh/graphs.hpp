// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "cells/cell_arrays.hpp"
#include "cells/facets.hpp"
#include "cells/vertex_joins.hpp"
#include <meshorder/mesh.hpp>

namespace meshorder {

/// Returns the cells of a mesh in the form that the orderings take. The result refers to the mesh. O(blocks).
inline CellArrays cell_arrays(const Mesh& mesh) {
  CellArrays arrays;
  arrays.vertex_count = mesh.vertex_count();
  arrays.offsets = mesh.cells.offsets;
  arrays.vertices = mesh.cells.vertices;
  arrays.shapes = mesh.cells.shapes;
  arrays.block_starts = mesh.cell_blocks;
  return arrays;
}

/// Returns the graph that joins the vertices of each element or piece of an element (vertex_joins.hpp).
/// Vertices without elements have no neighbours. O(sum of piece sizes squared · log degree).
inline CsrGraph vertex_graph(const Mesh& mesh) { return vertex_graph(cell_arrays(mesh)); }

/// Returns the graph that joins elements that share a facet: a face of a volume, an edge of a surface, an end
/// of a line. Elements are in the order of cells. Facets are the same if they have the same corners, in any
/// order. O(facets · log facets at a vertex).
inline CsrGraph facet_graph(const Mesh& mesh) {
  const CellArrays cells = cell_arrays(mesh);
  return joined_by_facet(cells, CellSelection::elements(cells));
}

}  // namespace meshorder
