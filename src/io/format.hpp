// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"
#include <meshorder/permutation.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Warnings for the user: what was dropped, repaired or looks wrong. The library never prints.
using Notes = std::vector<std::string>;

/// A file format: its name, its file extensions, its reader and its writer.
///
/// Readers throw Error for every fault of a file and must return a mesh that passes `check_mesh`. Writers
/// leave no partial file and note the parts of the mesh that the format has no place for.
struct Format {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< with dot, lower case
  bool groups_cells_by_type;                 ///< whether files keep the cells of a type together
  Mesh (*read)(const std::filesystem::path&, Notes&);
  void (*write)(const Mesh&, const std::filesystem::path&, Notes&);
};

/// Returns all formats, in the order of the help text.
std::span<const Format> formats();

/// Returns the format that belongs to the extension of `path`, in any case. Throws Error, which lists the
/// known extensions, if there is none.
const Format& format_of(const std::filesystem::path& path);

/// Reads a mesh in the format of its extension and checks it (`check_mesh`). Throws Error that names the file
/// for bad input and for a mesh without cells. `notes` receives warnings, if given.
Mesh read_mesh(const std::filesystem::path& path, Notes* notes = nullptr);

/// Writes a mesh in the format of the extension. `notes` receives warnings, if given: the parts of the mesh
/// that the format has no place for. Throws Error, and leaves no file, if the format does not support the
/// cells or the target cannot be written; InvalidArgument if the mesh fails `check_mesh`.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, Notes* notes = nullptr);

/// Prepares a mesh of format `from` for reordering and writing in format `to`: drops blocks, which bind cells
/// in their own format only, and groups the cells by type, each type a block, if `to` does. Returns the
/// applied permutation of cells. Reordering afterwards describes the cells as they are in the file.
Permutation arrange_cells(Mesh& mesh, const Format& from, const Format& to);

}  // namespace meshorder
