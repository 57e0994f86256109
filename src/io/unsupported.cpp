// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <string>

namespace meshorder {

void note_array_unsupported(const DataArray& array, std::string_view format, Notes& notes) {
  notes.push_back(fmt::format("the array '{}' on {} is not written: {} cannot hold it", array.name,
                              to_string(array.association), format));
}

void note_set_unsupported(const EntitySet& set, std::string_view format, Notes& notes) {
  notes.push_back(fmt::format("the set '{}' of {} is not written: {} cannot hold it", set.name,
                              to_string(set.association), format));
}

void note_set_empty(const EntitySet& set, Notes& notes) {
  notes.push_back(fmt::format("the set '{}' of {} is not written: it has no members", set.name,
                              to_string(set.association)));
}

void note_filled(const DataArray& array, std::string_view filling, Notes& notes) {
  notes.push_back(fmt::format("the array '{}' is given for some {}; the others get {}", array.name,
                              to_string(array.association), filling));
}

void note_component_names_unsupported(const DataArray& array, std::string_view format, Notes& notes) {
  if (array.component_names.empty()) return;
  notes.push_back(fmt::format("the names of the components of '{}' are not written: {} cannot hold them",
                              array.name, format));
}

void note_ids_unsupported(const Mesh& mesh, std::string_view format, Notes& notes) {
  for (const Association association : {Association::vertices, Association::cells}) {
    const auto& ids = association == Association::vertices ? mesh.vertex_ids : mesh.cell_ids;
    if (ids.empty()) continue;
    notes.push_back(fmt::format("the ids of {} are not written: {} numbers them by position",
                                to_string(association), format));
  }
}

void note_metadata_unsupported(const Mesh& mesh, std::string_view format, Notes& notes) {
  if (!mesh.format_metadata) return;
  for (const std::string& what : mesh.format_metadata->contents()) {
    notes.push_back(fmt::format("not written ({} cannot hold it): {}", format, what));
  }
}

}  // namespace meshorder
