// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"
#include "ordering/permutation.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Sentences for the user about what a reader met or a writer had to leave out; the library never prints.
using Notes = std::vector<std::string>;

/// A file format: its name, the extensions that stand for it, and how it is read and written.
///
/// Readers throw Error for every fault of a file, and never return a mesh that `check` refuses. Writers
/// leave no partial file behind, and note what of the mesh the format cannot hold.
struct Format {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< with their dot, lower case
  bool groups_cells_by_type;                 ///< cells of one type stand together in such a file
  Mesh (*read)(const std::filesystem::path&, Notes&);
  void (*write)(const Mesh&, const std::filesystem::path&, Notes&);
};

/// All formats, in the order in which help lists them.
std::span<const Format> formats();

/// The format of a path, by its extension (in any case). Throws Error that lists the known ones.
const Format& format_of(const std::filesystem::path& path);

/// Reads a mesh in the format that its extension names. Throws Error for bad input, also for a mesh without
/// cells. `notes` takes what deserves a word.
Mesh read_mesh(const std::filesystem::path& path, Notes* notes = nullptr);

/// Writes a mesh in the format that the extension names; what the format cannot hold is noted. Throws Error
/// when the mesh cannot be written or the target cannot be. Nothing is left behind then.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, Notes* notes = nullptr);

/// Prepares a mesh that was read in format `from` for being ordered and written in format `to`, and returns
/// the permutation of cells that this took. Blocks bind cells only within the format that they came from; a
/// format that keeps cells of one type together gets them so, each type a block, so that what is ordered then
/// is what the file holds.
Permutation arrange_cells(Mesh& mesh, const Format& from, const Format& to);

}  // namespace meshorder
