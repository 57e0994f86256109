// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/round_trip.hpp"

#include "fuzz/difference.hpp"
#include "fuzz/family.hpp"
#include "fuzz/input_files.hpp"
#include "io/format.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace meshorder::fuzz {
namespace {

/// Formats in which meshes of other formats are written. They need no library that reads files on disk, and
/// hold a point for each vertex.
constexpr std::array<std::string_view, 14> kOtherFormats{"gmsh",   "vtu",     "vtk", "medit", "tetgen",
                                                         "vega",   "off",     "ply", "obj",   "su2",
                                                         "abaqus", "nastran", "unv", "ucd"};

Mesh read(std::string_view format, const std::vector<MemoryFile>& files) {
  const MemoryFile& first = files.front();
  return read_mesh(std::as_bytes(std::span(first.bytes)),
                   {.format = std::string(format),
                    .name = first.name,
                    .companion = [&](std::string_view name) { return bytes_of(files, name); }});
}

/// Reads files that may be faulty; returns nothing if they are refused, with a message of one line.
std::optional<Mesh> read_any(std::string_view format, const std::vector<MemoryFile>& files) {
  std::string message;
  try {
    return read(format, files);
  } catch (const InputError& error) {
    message = error.what();
  } catch (const Unavailable& error) {
    message = error.what();
  }
  if (message.find('\n') != std::string::npos) fail("the message is not one line: " + message);
  return {};
}

/// Reads files that were written just now; aborts if the reader throws.
Mesh read_back(std::string_view format, const std::vector<MemoryFile>& files) {
  try {
    return read(format, files);
  } catch (const InputError& error) {
    fail("what was written as " + std::string(format) + " is refused: " + error.what());
  }
}

/// Returns the files of a written mesh; nothing if the format cannot hold the mesh.
std::optional<MemoryFiles> written(const Mesh& mesh, std::string_view format, const std::string& name,
                                   Notes& notes) {
  try {
    return write_mesh_to_memory(mesh, format, name, &notes);
  } catch (const InputError&) {
    return {};
  }
}

void move(Mesh& mesh) {
  const auto seed = static_cast<std::uint64_t>(mesh.vertex_count()) * 7 + 1;
  apply_reordering(mesh, test::shuffled(mesh.vertex_count(), seed), test::shuffled_cells(mesh, seed + 1));
  check_mesh(mesh);
}

/// Returns what a format promises to keep: STL has no numbers of vertices, and files of matrices and graphs
/// have an order and direction of entries of their own.
Extent extent_of(std::string_view format, bool is_whole) {
  if (format == "stl") return Extent::corners;
  if (format == "matrixmarket" || format == "metis") return Extent::pairs;
  return is_whole ? Extent::all : Extent::points_and_cells;
}

/// Returns the mesh without MED's numbers of families. The numbers of vertex families change if the file uses
/// them for families of cells, too.
Mesh without_families(Mesh mesh) {
  std::erase_if(mesh.data, [](const DataArray& array) { return array.name == "family"; });
  return mesh;
}

/// Returns whether numbers ascend by one from 0 or 1.
bool is_run(std::span<const std::int64_t> numbers) {
  const auto is_no_step = [](std::int64_t number, std::int64_t next) { return next != number + 1; };
  return !numbers.empty() && (numbers.front() == 0 || numbers.front() == 1) &&
         std::adjacent_find(numbers.begin(), numbers.end(), is_no_step) == numbers.end();
}

/// Returns whether the numbers of the cells of each dimension ascend by one from 0 or 1.
bool cells_run(const Mesh& mesh) {
  std::array<std::vector<std::int64_t>, 4> numbers;
  for (std::size_t c = 0; c < mesh.cell_ids.size(); ++c)
    numbers[static_cast<std::size_t>(dimension(mesh.cells.shapes[c]))].push_back(mesh.cell_ids[c]);
  return std::all_of(numbers.begin(), numbers.end(),
                     [](const auto& of_dimension) { return of_dimension.empty() || is_run(of_dimension); });
}

void check_same_format(const Mesh& mesh, std::string_view format, const std::string& name) {
  Notes notes;
  const std::optional<MemoryFiles> files = written(mesh, format, name, notes);
  if (!files) return;
  Mesh again = read_back(format, files->files);
  // cells that alternate between entities of Gmsh make no blocks; if the order has made the cells of an
  // entity adjacent, the mesh that is read back has blocks
  if (format == "gmsh" && mesh.cell_blocks.empty()) again.cell_blocks.clear();
  // Vega's reader takes ids that ascend by one from 0 or 1 for positions and drops them; so does TetGen's
  // reader, if the ids of each file ascend so.
  if (format == "tetgen" || format == "vega") {
    if (again.vertex_ids.empty() && is_run(mesh.vertex_ids)) again.vertex_ids = mesh.vertex_ids;
    if (again.cell_ids.empty() && cells_run(mesh)) again.cell_ids = mesh.cell_ids;
  }
  const Extent extent = extent_of(format, notes.empty());
  const std::string found = format == "med"
                                ? difference(without_families(again), without_families(mesh), extent)
                                : difference(again, mesh, extent);
  if (!found.empty()) fail("written and read as " + std::string(format) + ": " + found);
}

/// Writes a mesh in another format and reads it. Compares cells only: formats differ in arrays and sets.
void check_other_format(Mesh mesh, std::string_view format) {
  Notes notes;
  keep_cells(mesh, {.format = std::string(format)});
  if (mesh.cell_count() == 0) return;
  const std::string name = "other" + std::string(format_named(format).extensions.front());
  const std::optional<MemoryFiles> files = written(mesh, format, name, notes);
  if (!files) return;
  const Mesh again = read_back(format, files->files);
  apply_reordering(mesh, Permutation::identity(mesh.vertex_count()),
                   Permutation::identity(mesh.cell_count()));
  const std::string found = difference_of_cells(again.cells, mesh.cells, files->cells);
  if (!found.empty()) fail("written as " + std::string(format) + " and read: " + found);
}

}  // namespace

void check_mesh_files(std::string_view format, const std::vector<MemoryFile>& files) {
  std::optional<Mesh> mesh = read_any(format, files);
  if (!mesh) return;
  check_mesh(*mesh);
  move(*mesh);
  check_same_format(*mesh, format, files.front().name);
  // one input of four: other formats test little of this format's reader
  const std::size_t choice = std::hash<std::string>()(files.front().bytes);
  if (choice % 4 == 0) check_other_format(*std::move(mesh), kOtherFormats[choice / 4 % kOtherFormats.size()]);
}

}  // namespace meshorder::fuzz
