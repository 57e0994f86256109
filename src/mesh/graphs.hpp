// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include "mesh/mesh.hpp"

#include <vector>

namespace meshorder {

/// Some cells of a mesh and their vertices.
struct CellIncidence {
  std::vector<Index> cells;  ///< ascending; row e of `incidence` is cell `cells[e]`
  Incidence incidence;
};

/// Returns the cells of the highest dimension: the elements that are simulated. O(vertex entries).
CellIncidence elements(const Mesh& mesh);

/// Returns the cells of lower dimension: boundary faces, edges, points. O(vertex entries).
CellIncidence lower_dimensional_cells(const Mesh& mesh);

/// Returns the graph that joins any two vertices of a common element (the paper, section 3). Vertices
/// without elements have no neighbours. O(sum of element sizes squared · log degree).
CsrGraph vertex_graph(const Mesh& mesh);

/// Returns the graph of elements that share a facet, numbered as by `elements`: a face for volumes, an edge
/// for surfaces, an end for lines. Facets are the same if their corners are, in any order. O(facets · log
/// facets at a vertex).
CsrGraph facet_graph(const Mesh& mesh);

}  // namespace meshorder
