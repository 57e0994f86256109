// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/labels.hpp"

#include "base/text.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <type_traits>

namespace meshorder {

const DataArray* label_array(const Mesh& mesh, Association association, std::string_view name) {
  const DataArray* array = find_array(mesh, name, association);
  return array && array->components == 1 && are_integers(array->values) ? array : nullptr;
}

Labels labels_of(const Mesh& mesh, Association association, std::string_view name) {
  Labels result;
  const DataArray* array = label_array(mesh, association, name);
  if (!array) return result;
  const Index count = item_count(mesh, association);
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

void note_number_markers(const Mesh& mesh, std::string_view what, Notes& notes) {
  const Labels labels = mesh.format == "su2" ? labels_of(mesh, Association::cells) : Labels{};
  std::set<std::int64_t> numbers(labels.values.begin(), labels.values.end());
  numbers.erase(0);
  if (numbers.empty()) return;
  const std::string names = join(numbers, [](std::int64_t number) { return fmt::format("'{}'", number); });
  notes.push_back(numbers.size() == 1 ? fmt::format("the marker {} is written as {}", names, what)
                                      : fmt::format("the markers {} are written as {}", names, what));
}

Values label_values(std::vector<std::int64_t> labels) {
  if (!fit_32_bits(labels)) return labels;
  return std::vector<std::int32_t>(labels.begin(), labels.end());
}

}  // namespace meshorder
