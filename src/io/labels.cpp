// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/labels.hpp"

#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace meshorder {

const DataArray* label_array(const Mesh& mesh, Association association) {
  const DataArray* array = find_array(mesh, kLabel, association);
  if (!array || array->components != 1) return nullptr;
  const bool whole = std::visit(
      [](const auto& values) {
        return std::is_integral_v<typename std::decay_t<decltype(values)>::value_type>;
      },
      array->values);
  return whole ? array : nullptr;
}

Labels labels_of(const Mesh& mesh, Association association) {
  Labels result;
  const DataArray* array = label_array(mesh, association);
  if (!array) return result;
  const Index count = association == Association::vertices ? mesh.vertex_count() : mesh.cell_count();
  result.values.assign(count, 0);
  result.given.assign(count, array->is_dense());
  with_integers(array->values, [&](const auto& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t item = array->is_dense() ? i : static_cast<std::size_t>(array->indices[i]);
      result.values[item] = static_cast<std::int64_t>(values[i]);
      result.given[item] = true;
    }
  });
  return result;
}

void note_arrays_beside_cell_labels(const Mesh& mesh, std::string_view format, Notes& notes) {
  const DataArray* const labels = label_array(mesh, Association::cells);
  for (const DataArray& array : mesh.data) {
    if (&array != labels) note_array_unsupported(array, format, notes);
  }
}

Values label_values(std::vector<std::int64_t> labels) {
  using Limits = std::numeric_limits<std::int32_t>;
  const bool small = std::all_of(labels.begin(), labels.end(),
                                 [](std::int64_t x) { return x >= Limits::min() && x <= Limits::max(); });
  if (!small) return labels;
  return std::vector<std::int32_t>(labels.begin(), labels.end());
}

}  // namespace meshorder
