// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/groups.hpp"
#include "mesh/mesh.hpp"
#include "ordering/method.hpp"

#include <optional>
#include <string>
#include <vector>

namespace meshorder {

/// The orders that a mesh is given.
struct ReorderingOptions {
  std::string vertices = "auto";
  std::string elements = "auto";
  OrderOptions ordering = {};
  /// An array of integers (see `grouping_by`) whose groups stay together: vertices, and the cells of each
  /// dimension, are sorted by group, ascending by value, and within a group by their method; those without
  /// a value come last. Empty: no groups.
  std::string group_by = {};
};

/// New positions of a mesh's vertices and cells, and how they were found.
struct Reordering {
  Permutation vertices;
  Permutation cells;
  MethodChoice vertex_method;                     ///< the method asked for, or that `auto` chose, and why
  MethodChoice element_method;                    ///< likewise
  std::vector<FiedlerComponent> vertex_fiedler;   ///< empty unless the vertex order is a Fiedler order
  std::vector<FiedlerComponent> element_fiedler;  ///< likewise for the elements
  double vertex_seconds = 0;
  double element_seconds = 0;
  std::optional<Grouping> groups;  ///< of the mesh before reordering; none without `group_by`
};

/// Computes an order and leaves the mesh unchanged. Elements, the cells of the highest dimension, are ordered
/// by their method; cells of lower dimension by `lexmax` (or not at all if elements keep their order). Each
/// cell stays in its block, and each dimension keeps its positions (see `permutation_within_classes`).
/// `graph` is the mesh's vertex graph. Groups stay together within the blocks. Throws InvalidArgument for
/// unknown methods and arrays.
Reordering compute_reordering(const Mesh& mesh, const CsrGraph& graph, const ReorderingOptions& options);

/// Computes an order and applies it: `vertex_graph`, `compute_reordering`, `apply_reordering`.
Reordering reorder(Mesh& mesh, const ReorderingOptions& options = {});

/// Moves the vertices and cells of `mesh` to their new positions, together with all that belongs to them:
/// cells name the renumbered vertices, arrays and sets follow their vertices and cells.
///
/// Ids are sorted: the mesh keeps the same numbers, ascending along the new positions (for cells: within each
/// dimension of each block). Throws InvalidArgument if a size does not fit, or if `cells` moves a cell out of
/// its block or to the position of a cell of another dimension; the mesh is then unchanged. O(size of the
/// mesh) time; memory for a second copy of the largest part.
void apply_reordering(Mesh& mesh, const Permutation& vertices, const Permutation& cells);

/// Sorts the cells by dimension, highest first, then by type, keeping the order within a type; makes each
/// type a block; returns the applied permutation. For formats that keep the cells of a type together. O(size
/// of the mesh).
Permutation group_cells_by_type(Mesh& mesh);

}  // namespace meshorder
