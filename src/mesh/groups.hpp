// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Which group each vertex and each cell of a mesh belongs to: materials, regions, physical groups.
struct Grouping {
  std::string name;                              ///< of the array that says so, or "sets"
  Association association = Association::cells;  ///< what that array belongs to
  std::vector<std::int64_t> values;              ///< those that occur, rising: group g has values[g]
  std::vector<std::string> names;                ///< by sets: the name of each group's set; else empty
  std::vector<Index> of_vertices;  ///< a group for each vertex; values.size() where there is none
  std::vector<Index> of_cells;     ///< likewise for each cell; empty where the array is on vertices

  /// Groups, counted with the one of what has no value.
  [[nodiscard]] Index count() const noexcept { return index_size(values) + 1; }
};

/// The groups by an array of one whole number each (of an integer type, or real numbers without fractions, as
/// TetGen writes regions).
///
/// An array on cells groups the cells, and with them the vertices: a vertex belongs to the smallest value
/// among its elements, the cells of the highest dimension. An array on vertices groups the vertices alone. A
/// name that both have means the cells'; "cells:NAME" and "vertices:NAME" say which.
///
/// "sets", where no array has that name, groups the cells by the mesh's sets of cells, which Vega's regions
/// and Gmsh's named physical groups are, in the order of the file. A cell in several belongs to the smallest
/// (ties: the first), so that a set of everything does no harm; its value is the number of the set in
/// `mesh.sets`.
///
/// Throws InvalidArgument, which lists what would do, when there is no such array or it holds something else.
/// O(size of the mesh · log groups).
Grouping grouping_by(const Mesh& mesh, std::string_view name);

/// One group: its value (none for what has no value), the name of its set where sets group, its vertices and
/// its cells of all dimensions.
struct GroupSize {
  std::optional<std::int64_t> value;
  std::string name;
  Index vertices = 0;
  Index cells = 0;
};

/// The sizes of the groups in their order; the group without value only where anything is in it. O(vertices +
/// cells).
std::vector<GroupSize> group_sizes(const Grouping& grouping);

}  // namespace meshorder
