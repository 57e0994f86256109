// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <string_view>

namespace meshorder {

// Notes of writers on parts of a mesh that their format cannot hold, worded alike for all formats.

/// Notes "the array 'stress' on cells is not written: OFF cannot hold it".
void note_array_unsupported(const DataArray& array, std::string_view format, Notes& notes);

/// Notes "the set 'fixed' of vertices is not written: OFF cannot hold it".
void note_set_unsupported(const EntitySet& set, std::string_view format, Notes& notes);

/// Notes "the set 'fixed' of vertices is not written: it has no members".
void note_set_empty(const EntitySet& set, Notes& notes);

/// Returns `missing_value` of these values as text.
inline const char* missing_word(const Values& values) { return values.index() <= 1 ? "NaN" : "0"; }

/// Notes "the array 'stress' is given for some cells; the others get NaN".
void note_filled(const DataArray& array, std::string_view filling, Notes& notes);

/// Notes that the names of the components of an array are not written, if it has any.
void note_component_names_unsupported(const DataArray& array, std::string_view format, Notes& notes);

/// Notes that the ids of vertices and cells are not written, if there are any.
void note_ids_unsupported(const Mesh& mesh, std::string_view format, Notes& notes);

/// Notes that the contents of another format's metadata are not written, if there are any.
void note_metadata_unsupported(const Mesh& mesh, std::string_view format, Notes& notes);

}  // namespace meshorder
