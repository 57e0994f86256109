// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "mesh/mesh.hpp"

namespace meshorder {

/// A mesh that no order of another one can be, but that is as large and streams as well as an order could.
struct Band {
  Mesh mesh;
  CsrGraph graph;  ///< what KernelBench takes for the mesh's vertex graph
};

/// The ideal streaming order of a problem of that size: as many vertices, edges and simplices as `mesh` has,
/// with vertex i joined to i ± 1 … ± k, and the simplices from the first vertices to the last, each on
/// vertices i … i + k and all its ways to choose them in turn, so that simplices use every edge as those of a
/// mesh do. Every kernel then reads and writes memory front to back and finds in the nearest cache what it
/// needs again: its times are a practical floor for the orders of `mesh`, which must pay for the cuts through
/// a body of two or three dimensions.
///
/// `graph` is the vertex graph of `mesh`. The counts are exact, save that a degenerate mesh gets the edges
/// that its simplices need. As many vertices as in the mesh have no neighbours, and come last. The points
/// lie on a helix, so that no simplex is flat. O(n + edges + cells). Throws InvalidArgument when the graph
/// belongs to another mesh.
Band ideal_band(const Mesh& mesh, const CsrGraph& graph);

}  // namespace meshorder
