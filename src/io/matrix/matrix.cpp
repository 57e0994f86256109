// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/matrix/matrix.hpp"

#include "base/memory.hpp"
#include "io/stream/read_limits.hpp"
#include "io/unsupported.hpp"
#include "mesh/stored_matrix.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>

namespace meshorder::matrix {

bool is_entry(const Mesh& /*mesh*/, Shape shape, int vertices) {
  return (shape == Shape::line && vertices == 2) || (shape == Shape::vertex && vertices == 1);
}

void claim_vertices(Index count) {
  constexpr std::uint64_t kBytes = 12;  // bytes of a vertex; each byte is counted kCopiesOfClaim times
  claim_memory(bytes_for(static_cast<std::uint64_t>(count), kBytes), "the vertices");
}

const DataArray* dense_array(const Mesh& mesh, std::string_view name, Association association) {
  const DataArray* const array = find_array(mesh, name, association);
  const bool usable = array != nullptr && array->is_dense() && !are_texts(array->values);
  return usable ? array : nullptr;
}

bool is_whole(const DataArray& array) {
  return with_integers(array.values, []<class Value>(const std::vector<Value>& values) {
    return std::all_of(values.begin(), values.end(),
                       [](Value value) { return std::in_range<std::int64_t>(value); });
  });
}

double real_value(const DataArray& array, Offset at) {
  return with_numbers(array.values, [&](const auto& values) { return static_cast<double>(values[at]); });
}

std::int64_t whole_value(const DataArray& array, Offset at) {
  return with_integers(array.values,
                       [&](const auto& values) { return static_cast<std::int64_t>(values[at]); });
}

void note_all_unsupported(const Mesh& mesh, std::string_view format,
                          std::span<const DataArray* const> written, Notes& notes) {
  // the points of a matrix came from another file: they are not lost
  if (stored_matrix(mesh) == nullptr && has_places(mesh)) {
    notes.push_back(fmt::format("the coordinates of vertices are not written: {} cannot hold them", format));
  }
  for (const DataArray& array : mesh.data) {
    if (std::find(written.begin(), written.end(), &array) == written.end()) {
      note_array_unsupported(array, format, notes);
    }
  }
  for (const EntitySet& set : mesh.sets) note_set_unsupported(set, format, notes);
  note_ids_unsupported(mesh, format, notes);
}

}  // namespace meshorder::matrix
