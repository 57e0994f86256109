// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The group of each vertex and each cell of a mesh, such as a material, a region or a physical group.
struct Grouping {
  std::string name;                              ///< name of the array, or "sets"
  Association association = Association::cells;  ///< association of that array
  std::vector<std::int64_t> values;              ///< distinct, ascending: group g has values[g]
  std::vector<std::string> names;                ///< for sets: the name of each group's set; else empty
  std::vector<Index> of_vertices;                ///< the group of each vertex; values.size(): no group
  std::vector<Index> of_cells;  ///< the group of each cell; empty if the array is on vertices

  /// Returns the number of groups, including the group without value.
  [[nodiscard]] Index count() const noexcept { return index_size(values) + 1; }
};

/// Groups a mesh by an array with one whole number for each cell or vertex. The numbers may be of a real
/// type, as TetGen's regions are.
///
/// An array on cells groups the cells and the vertices: each vertex gets the smallest value among its
/// elements, the cells of the highest dimension. An array on vertices groups only the vertices. If cells and
/// vertices both have an array of that name, the array on cells is used; "cells:NAME" and "vertices:NAME"
/// choose one of them.
///
/// If no array is called "sets", that name groups the cells by the mesh's sets of cells, such as Vega's
/// regions and Gmsh's named physical groups. A cell in several sets belongs to the group of the smallest set
/// (ties: the first in the file). The value of a group is the index of its set in `mesh.sets`.
///
/// Throws InvalidArgument, which lists the usable arrays, if there is no such array or its values are not
/// whole numbers. O(size of the mesh + rows · log rows).
Grouping grouping_by(const Mesh& mesh, std::string_view name);

/// The size of one group: its value (none for the group without value), the name of its set (when grouped by
/// sets), its vertices and its cells of all dimensions.
struct GroupSize {
  std::optional<std::int64_t> value;
  std::string name;
  Index vertices = 0;
  Index cells = 0;
};

/// Returns the sizes of the groups in their order; the group without value only if it is not empty.
/// O(vertices + cells).
std::vector<GroupSize> group_sizes(const Grouping& grouping);

}  // namespace meshorder
