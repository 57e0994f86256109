// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/groups.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace meshorder {
namespace {

/// Returns a whole number as int64; nothing for other values, integers that int64 cannot hold, and reals of
/// magnitude 2⁶² or more.
template <class Value>
std::optional<std::int64_t> whole(const Value& value) {
  if constexpr (std::is_integral_v<Value>) {
    if (std::in_range<std::int64_t>(value)) return static_cast<std::int64_t>(value);
  } else if constexpr (std::is_floating_point_v<Value>) {
    if (std::abs(value) < Value(0x1p62) && value == std::floor(value)) {
      return static_cast<std::int64_t>(value);
    }
  }
  return std::nullopt;
}

/// Returns the values of an array if each row is one whole number; else nothing.
std::optional<std::vector<std::int64_t>> whole_numbers(const DataArray& array) {
  if (array.components != 1) return std::nullopt;
  return std::visit(
      [](const auto& values) -> std::optional<std::vector<std::int64_t>> {
        std::vector<std::int64_t> result;
        result.reserve(values.size());
        for (const auto& value : values) {
          const std::optional<std::int64_t> number = whole(value);
          if (!number) return std::nullopt;
          result.push_back(*number);
        }
        return result;
      },
      array.values);
}

bool has_cell_sets(const Mesh& mesh) {
  return std::any_of(mesh.sets.begin(), mesh.sets.end(),
                     [](const EntitySet& set) { return set.association == Association::cells; });
}

/// Returns what a mesh can be grouped by, such as "label on cells, part on vertices, sets"; or "none".
std::string usable_names(const Mesh& mesh) {
  std::string list;
  for (const DataArray& array : mesh.data) {
    if (!whole_numbers(array)) continue;
    list += (list.empty() ? "" : ", ") + array.name + " on " + std::string(to_string(array.association));
  }
  if (has_cell_sets(mesh)) list += list.empty() ? "sets" : ", sets";
  return list.empty() ? "none" : list;
}

/// Returns the array called `name`, on cells or else on vertices; without such an array, the one that `name`
/// means in the form "cells:NAME" or "vertices:NAME"; nullptr if there is none.
const DataArray* array_meant(const Mesh& mesh, std::string_view name) {
  for (const Association association : {Association::cells, Association::vertices}) {
    if (const DataArray* array = find_array(mesh, name, association)) return array;
  }
  for (const Association association : {Association::cells, Association::vertices}) {
    const std::string prefix = std::string(to_string(association)) + ":";
    if (name.starts_with(prefix)) return find_array(mesh, name.substr(prefix.size()), association);
  }
  return nullptr;
}

/// Sets `values` to the distinct numbers, ascending. Returns for each vertex or cell the index of its number
/// in `values`, or `values.size()` if it has no number.
std::vector<Index> numbered(const DataArray& array, const std::vector<std::int64_t>& numbers, Index count,
                            std::vector<std::int64_t>& values) {
  values = numbers;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<Index> groups(static_cast<std::size_t>(count), index_size(values));
  for (std::size_t row = 0; row < numbers.size(); ++row) {
    const auto owner = array.is_dense() ? row : static_cast<std::size_t>(array.indices[row]);
    groups[owner] =
        static_cast<Index>(std::lower_bound(values.begin(), values.end(), numbers[row]) - values.begin());
  }
  return groups;
}

/// Returns the smallest group among the elements at each vertex; `none` for a vertex without elements.
std::vector<Index> smallest_at_vertices(const Mesh& mesh, const std::vector<Index>& of_cells, Index none) {
  std::vector<Index> groups(mesh.points.size(), none);
  const int highest = mesh.cells.highest_dimension();
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (dimension(mesh.cells.shapes[c]) != highest) continue;
    for (const Index v : mesh.cells[c]) groups[v] = std::min(groups[v], of_cells[c]);
  }
  return groups;
}

/// Groups each cell by the smallest set that has the cell. Sets that are no cell's smallest make no group.
Grouping grouping_by_sets(const Mesh& mesh) {
  std::vector<const EntitySet*> set_of(mesh.cells.shapes.size(), nullptr);
  for (const EntitySet& set : mesh.sets) {
    if (set.association != Association::cells) continue;
    for (const Index c : set.members) {
      if (!set_of[c] || set.members.size() < set_of[c]->members.size()) set_of[c] = &set;
    }
  }
  Grouping result;
  result.name = "sets";
  DataArray numbers{"sets", Association::cells, 1, {}, {}, {}};
  std::vector<std::int64_t> values;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (!set_of[c]) continue;
    numbers.indices.push_back(c);
    values.push_back(set_of[c] - mesh.sets.data());
  }
  result.of_cells = numbered(numbers, values, mesh.cell_count(), result.values);
  for (const std::int64_t s : result.values) result.names.push_back(mesh.sets[s].name);
  return result;
}

}  // namespace

Grouping grouping_by(const Mesh& mesh, std::string_view name) {
  const DataArray* array = array_meant(mesh, name);
  Grouping result;
  if (!array && name == "sets" && has_cell_sets(mesh)) {
    result = grouping_by_sets(mesh);
    result.of_vertices = smallest_at_vertices(mesh, result.of_cells, index_size(result.values));
    return result;
  }
  if (!array) {
    throw InvalidArgument("group by: the mesh has no array '" + std::string(name) +
                          "'; arrays you can group by: " + usable_names(mesh));
  }
  const std::optional<std::vector<std::int64_t>> numbers = whole_numbers(*array);
  if (!numbers) {
    throw InvalidArgument(
        "group by: the array '" + array->name + "' on " + std::string(to_string(array->association)) +
        " does not hold one whole number each; arrays you can group by: " + usable_names(mesh));
  }
  result.name = array->name;
  result.association = array->association;
  if (array->association == Association::vertices) {
    result.of_vertices = numbered(*array, *numbers, mesh.vertex_count(), result.values);
  } else {
    result.of_cells = numbered(*array, *numbers, mesh.cell_count(), result.values);
    result.of_vertices = smallest_at_vertices(mesh, result.of_cells, index_size(result.values));
  }
  return result;
}

std::vector<GroupSize> group_sizes(const Grouping& grouping) {
  std::vector<GroupSize> sizes(grouping.values.size() + 1);
  for (std::size_t g = 0; g < grouping.values.size(); ++g) {
    sizes[g].value = grouping.values[g];
    if (!grouping.names.empty()) sizes[g].name = grouping.names[g];
  }
  for (const Index group : grouping.of_vertices) ++sizes[group].vertices;
  for (const Index group : grouping.of_cells) ++sizes[group].cells;
  if (sizes.back().vertices == 0 && sizes.back().cells == 0) sizes.pop_back();
  return sizes;
}

}  // namespace meshorder
