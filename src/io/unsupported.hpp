// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace meshorder {

/// What writers note about parts of a mesh that their format cannot hold, in one wording for all formats.

/// "the array 'stress' on cells is left out: OFF cannot hold it".
void note_array_unsupported(const DataArray& array, std::string_view format, Notes& notes);

/// "the set 'fixed' of vertices is left out: OFF cannot hold it".
void note_set_unsupported(const EntitySet& set, std::string_view format, Notes& notes);

/// Notes the mesh's numbers of vertices and cells, where it has any.
void note_ids_unsupported(const Mesh& mesh, std::string_view format, Notes& notes);

/// Notes the contents of a residue that another format left, if there is one.
void note_metadata_unsupported(const Mesh& mesh, std::string_view format, Notes& notes);

/// Throws Error when `holds(shape, vertices)` is false for a cell of the mesh; the message names its type.
void require_supported_cells(const Mesh& mesh, const std::filesystem::path& path, std::string_view format,
                             bool (*holds)(Shape shape, int vertices), const std::string& remedy);

}  // namespace meshorder
