// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/groups.hpp"
#include "mesh/mesh.hpp"
#include "ordering/method.hpp"

#include <optional>
#include <string>
#include <vector>

namespace meshorder {

/// Which orders a mesh is given.
struct ReorderingOptions {
  std::string vertices = "auto";
  std::string elements = "auto";
  OrderingOptions ordering = {};
  /// An array of whole numbers (see `grouping_by`) whose groups stay together: the vertices, and the cells of
  /// each dimension, stand group after group by rising value, each in the methods' order; what has no value
  /// comes last. Empty: no groups.
  std::string group_by = {};
};

/// New places for a mesh's vertices and cells, and how they were found.
struct Reordering {
  Permutation vertices;
  Permutation cells;
  MethodChoice vertex_method;                     ///< the one asked for, or the one that `auto` took, and why
  MethodChoice element_method;                    ///< likewise
  std::vector<FiedlerComponent> vertex_fiedler;   ///< where the vertex order is a Fiedler order
  std::vector<FiedlerComponent> element_fiedler;  ///< where the element order is one
  double vertex_seconds = 0;
  double element_seconds = 0;
  std::optional<Grouping> groups;  ///< where groups were asked for, of the mesh as it was
};

/// Computes an order, changes nothing. Elements, the cells of the highest dimension, go by their method;
/// cells of lower dimension follow `lexmax` (they stay where they are when elements do). Each cell keeps to
/// its block, and each dimension to its places (see `permutation_within_blocks`). `graph` is the mesh's
/// vertex graph. Groups, where asked for, stay together within the blocks. Throws InvalidArgument for unknown
/// methods and arrays.
Reordering compute_reordering(const Mesh& mesh, const CsrGraph& graph, const ReorderingOptions& options);

/// Computes an order and applies it: `vertex_graph`, `compute_reordering`, `reorder`.
Reordering reorder(Mesh& mesh, const ReorderingOptions& options = {});

}  // namespace meshorder
