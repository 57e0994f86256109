// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh_files.hpp"

#include "confinement.hpp"
#include "io/kept_cells.hpp"
#include "io/stream/output_set.hpp"
#include "matrix_points.hpp"
#include "wording.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace meshorder::command {

void add_moving_options(CLI::App& subcommand, MeshFiles& files, std::string& ids,
                        const std::string& more_maps) {
  add_ids_option(subcommand, ids);
  add_keeping_options(subcommand, files.keeping);
  subcommand.add_option(
      "--maps", files.maps,
      "Also write the permutations as NumPy files, PREFIX.vertices.old_to_new.npy and so on, and\n"
      "PREFIX.maps.json, by which `apply` recognises the mesh" +
          more_maps);
}

std::vector<Index> keep_wanted(Mesh& mesh, const std::string& input, int dimension, Notes& notes) {
  try {
    return keep_dimension(mesh, dimension, notes);
  } catch (const InvalidArgument& fault) {
    throw InputError(input, fault.what(), "it has " + cells_in_words(mesh));
  }
}

MeshToOrder read_to_order(const MeshFiles& files, Notes& notes, std::uint64_t bytes_of_entry) {
  MeshToOrder result;
  Mesh& mesh = result.mesh;
  mesh = read_input(files.input, notes, bytes_of_entry);
  result.format = &output_format_of(files.output, mesh.format);
  const Index cells_read = mesh.cell_count();
  const std::vector<Index> wanted = keep_wanted(mesh, files.input, files.keeping.dimension, notes);
  const std::vector<Index> held =
      cells_to_write(mesh, files.output, *result.format, files.keeping.strict, notes);
  keep_cells_at(mesh, held, notes);
  if (mesh.cell_count() < cells_read) {
    result.maps.kept.reserve(held.size());
    for (const Index c : held) result.maps.kept.push_back(wanted[c]);
  }
  result.maps.vertex_ids = mesh.vertex_ids;
  result.maps.cell_ids = mesh.cell_ids;
  if (!files.maps.empty()) result.before = checksums_of(mesh);
  take_points(mesh, files.input, files.points);
  return result;
}

std::vector<std::string> files_of_mesh(const OutputSet& outputs, const std::string& output) {
  std::vector<std::string> files = outputs.files();
  std::stable_partition(files.begin(), files.end(), [&](const std::string& file) { return file == output; });
  return files;
}

WrittenFiles write_ordered(const MeshToOrder& ordered, const MeshFiles& files, OutputSet& outputs,
                           Notes& notes) {
  WrittenFiles written;
  if (!files.output.empty()) {
    write_arranged(ordered.mesh, {files.output, outputs}, {.strict = files.keeping.strict, .notes = &notes},
                   *ordered.format);
    written.mesh = files_of_mesh(outputs, files.output);
  }
  if (files.maps.empty()) return written;
  MeshChecksums after = checksums_of(ordered.mesh);
  // a matrix or graph is written as it was read, without the points given for its rows
  const bool lacks_points = ordered.format->name == "MatrixMarket" || ordered.format->name == "METIS";
  if (!files.points.empty() && lacks_points) after.points = ordered.before.points;
  written.maps = write_maps(ordered.maps, ordered.before, after, files.maps, outputs);
  return written;
}

}  // namespace meshorder::command
