// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"

#include "io/all_formats.hpp"
#include "mesh/reorder.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

namespace meshorder {
namespace {

const std::array kFormats{
    tetgen_format(), vega_format(), gmsh_format(), medit_format(), vtu_format(),
    vtk_format(),    off_format(),  obj_format(),  ply_format(),   stl_format(),
};

}  // namespace

std::span<const Format> formats() { return kFormats; }

const Format& format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::error_code code; extension.empty() && std::filesystem::is_directory(path, code)) {
    throw InputError(path.string(), "is a folder", "give a mesh file");
  }
  std::string known;
  for (const Format& format : kFormats) {
    for (const std::string_view candidate : format.extensions) {
      if (candidate == extension) return format;
      known += (known.empty() ? "" : " ") + std::string(candidate);
    }
  }
  throw InputError(path.string(),
                   extension.empty() ? "has no extension" : "unknown extension '" + extension + "'",
                   "known are " + known);
}

Mesh read_mesh(const std::filesystem::path& path, Notes* notes) {
  Notes ignored;
  Notes& noted = notes != nullptr ? *notes : ignored;
  Mesh mesh = format_of(path).read(path, noted);
  if (mesh.cell_count() == 0) throw InputError(path.string(), "has no cells", "a mesh needs at least one");
  try {
    check_mesh(mesh);
  } catch (const InvalidArgument& fault) {
    throw InputError(path.string(), fault.what(), "the file may be damaged");
  }
  const std::vector<Index> degenerate = degenerate_cells(mesh);
  if (!degenerate.empty()) {
    noted.push_back(std::to_string(degenerate.size()) +
                    (degenerate.size() == 1 ? " cell names a vertex twice and is kept"
                                            : " cells name a vertex twice and are kept") +
                    ": the first is cell " + std::to_string(degenerate.front()) + ", counted from 0");
  }
  return mesh;
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, Notes* notes) {
  Notes ignored;
  check_mesh(mesh);
  format_of(path).write(mesh, path, notes ? *notes : ignored);
}

Permutation arrange_cells(Mesh& mesh, const Format& from, const Format& to) {
  if (from.name == to.name) return Permutation::identity(mesh.cell_count());
  mesh.cell_blocks.clear();
  return to.groups_cells_by_type ? group_cells_by_type(mesh) : Permutation::identity(mesh.cell_count());
}

}  // namespace meshorder
