// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh/mesh.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Which group each vertex and each cell of a mesh belongs to: materials, regions, physical groups.
struct Grouping {
  std::string name;                  ///< of the array that says so
  Attached on = Attached::cells;     ///< what that array belongs to
  std::vector<std::int64_t> values;  ///< those that occur, rising: group g has values[g]
  std::vector<Index> of_vertices;    ///< a group for each vertex; values.size() where there is none
  std::vector<Index> of_cells;       ///< likewise for each cell; empty where the array is on vertices

  /// Groups, counted with the one of what has no value.
  [[nodiscard]] Index count() const noexcept { return index_size(values) + 1; }
};

/// The groups by an array of one whole number each (of an integer type, or real numbers without fractions, as
/// TetGen writes regions).
///
/// An array on cells groups the cells, and with them the vertices: a vertex belongs to the smallest value
/// among its elements, the cells of the highest dimension. An array on vertices groups the vertices alone. A
/// name that both have means the cells'; "cells:NAME" and "vertices:NAME" say which. Throws InvalidArgument,
/// which lists the arrays that would do, when there is no such array or it holds something else.
/// O(size of the mesh · log groups).
Grouping grouping_by(const Mesh& mesh, std::string_view name);

/// One group: its value (none for what has no value), its vertices and its cells of all dimensions.
struct GroupSize {
  std::optional<std::int64_t> value;
  Index vertices = 0;
  Index cells = 0;
};

/// The sizes of the groups in their order; the group without value only where anything is in it. O(vertices +
/// cells).
std::vector<GroupSize> group_sizes(const Grouping& grouping);

}  // namespace meshorder
