// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "mesh/simplices.hpp"
#include "mesh/stored_matrix.hpp"
#include <meshorder/mesh.hpp>

namespace meshorder {

/// A synthetic mesh of a given mesh's size whose kernels read memory front to back: a reference for times.
struct Band {
  Mesh mesh;
  CsrGraph graph;  ///< pass it to KernelInput as the vertex graph of the mesh
};

/// Returns the ideal streaming problem of a mesh's size, with as many vertices, edges and simplices as the
/// mesh. Vertex i is joined to i ± 1 … i ± k. Each simplex has its vertices among i … i + k, ascending; all
/// combinations occur, so that simplices use every edge, as in a mesh. Every kernel reads and writes memory
/// front to back and finds reused data in the first cache. The problem is a reference: no order of a mesh of
/// two or three dimensions can be as good.
///
/// The counts are exact, except that a degenerate mesh gets the edges that its simplices need. The number of
/// vertices without neighbours is that of the mesh; they come last. The points lie on a helix, so that no
/// simplex is flat. O(n + edges + cells).
///
/// @param simplices  the simplices into which the mesh is cut
/// @param graph      the vertex graph of the mesh
Band ideal_band(SimplicesRef simplices, const CsrGraph& graph);

/// Returns a pattern with as many rows and entries as `pattern`. The entries are spread evenly over the rows
/// and are consecutive columns around the diagonal: a reference for products. O(entries).
EntryPattern ideal_pattern(const EntryPattern& pattern);

}  // namespace meshorder
