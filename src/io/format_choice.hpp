// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <filesystem>
#include <string_view>

namespace meshorder {

// Chooses between the two formats of the extension .inp, Abaqus decks and AVS UCD; says which formats have
// numbers.

/// As `format_of`, for a file to be read: .inp is AVS UCD if its first bytes look so, else Abaqus. Throws
/// InputError for an .inp file that cannot be read.
const Format& format_of_file(const FilePath& path);

/// As `output_format_of`, for a mesh of the format `of_mesh` (`Mesh::format`): .inp means AVS UCD if the mesh
/// came from it, else Abaqus.
const Format& output_format_of(const std::filesystem::path& path, std::string_view of_mesh);

/// Returns whether files of a format give vertices and cells numbers, by which other files may name them.
bool has_numbers(const Format& format);

}  // namespace meshorder
