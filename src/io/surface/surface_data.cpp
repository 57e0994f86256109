// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/surface/surface_data.hpp"

#include "mesh/values.hpp"

#include <algorithm>
#include <string>
#include <type_traits>
#include <variant>

namespace meshorder {
namespace {

bool is_usable(const DataArray* array) { return array && array->is_dense() && !are_texts(array->values); }

/// Returns the columns row by row: the first value of each, then the second, …
std::vector<double> interleaved(const std::vector<const DataArray*>& columns, Index rows) {
  std::vector<double> result(columns.size() * static_cast<std::size_t>(rows));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::vector<double> column = as_reals(columns[k]->values);
    for (Index i = 0; i < rows; ++i) result[i * columns.size() + k] = column[i];
  }
  return result;
}

}  // namespace

GatheredVector gather(const Mesh& mesh, const SurfaceVector& vector, Association association) {
  GatheredVector result;
  const int most = static_cast<int>(vector.components.size());
  // one array of all components
  const DataArray* whole = find_array(mesh, vector.name, association);
  if (is_usable(whole) && whole->components >= vector.least && whole->components <= most) {
    return {whole->components, are_integers(whole->values), as_reals(whole->values), {whole}};
  }
  // or an array for each component, all of one type
  for (const std::string_view component : vector.components) {
    const DataArray* array = find_array(mesh, component, association);
    if (!is_usable(array) || array->components != 1) break;
    if (!result.from.empty() && array->values.index() != result.from[0]->values.index()) break;
    result.from.push_back(array);
  }
  if (static_cast<int>(result.from.size()) < vector.least) return {};
  result.width = static_cast<int>(result.from.size());
  result.integers = are_integers(result.from[0]->values);
  result.values = interleaved(result.from,
                              association == Association::vertices ? mesh.vertex_count() : mesh.cell_count());
  return result;
}

Shape face_shape(Index vertices) {
  constexpr std::array kShapesOf{Shape::vertex, Shape::line, Shape::triangle, Shape::quad};
  return vertices <= 4 ? kShapesOf[vertices - 1] : Shape::polygon;
}

}  // namespace meshorder
