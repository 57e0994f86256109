// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh/mesh.hpp>
#include <meshorder/ordering/method.hpp>

#include <string>
#include <vector>

namespace meshorder {

/// Which orders a mesh is given.
struct ReorderingOptions {
  std::string vertices = "fiedler";
  std::string elements = "lexmax";
  OrderingOptions ordering = {};
};

/// New places for a mesh's vertices and cells, and how they were found.
struct Reordering {
  Permutation vertices;
  Permutation cells;
  std::vector<FiedlerComponent> vertex_fiedler;   ///< where the vertex order is a Fiedler order
  std::vector<FiedlerComponent> element_fiedler;  ///< where the element order is one
  double vertex_seconds = 0;
  double element_seconds = 0;
};

/// Computes an order, changes nothing. Elements, the cells of the highest dimension, go by their method;
/// cells of lower dimension follow `lexmax` (they stay where they are when elements do). Each cell keeps to
/// its block, and each dimension to its places (see `permutation_within_blocks`). `graph` is the mesh's
/// vertex graph. Throws InvalidArgument for unknown methods.
Reordering compute_reordering(const Mesh& mesh, const CsrGraph& graph, const ReorderingOptions& options);

/// Computes an order and applies it: `vertex_graph`, `compute_reordering`, `reorder`.
Reordering reorder(Mesh& mesh, const ReorderingOptions& options = {});

}  // namespace meshorder
