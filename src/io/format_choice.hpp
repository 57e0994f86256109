// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <filesystem>
#include <string_view>

namespace meshorder {

// Which of two formats a file with the extension .inp has, that of decks or AVS UCD, and what follows from a
// format.

/// As `format_of`, of a file to be read: .inp is AVS UCD where its first bytes are, else Abaqus. Throws
/// InputError for an unreadable file of that extension.
const Format& format_of_file(const FilePath& path);

/// As `output_format_of`, for a mesh of that format (`Mesh::format`): .inp stays AVS UCD for one that came
/// from it.
const Format& output_format_of(const std::filesystem::path& path, std::string_view of_mesh);

/// Returns whether files of a format give vertices and cells numbers, by which other files may name them.
bool has_numbers(const Format& format);

}  // namespace meshorder
