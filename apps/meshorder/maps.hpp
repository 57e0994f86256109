// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::command {

/// The reordering of a mesh file, on disk as NumPy arrays: PREFIX.vertices.old_to_new.npy and
/// PREFIX.vertices.new_to_old.npy, and PREFIX.elements.*.npy for all cells. If the input numbers its vertices
/// or cells other than from 0 or 1 on, PREFIX.vertices.ids.npy or PREFIX.elements.ids.npy holds these numbers
/// in the input's order.
struct Maps {
  Permutation vertices;
  Permutation cells;
  std::vector<std::int64_t> vertex_ids;
  std::vector<std::int64_t> cell_ids;
};

/// Writes the maps and returns the paths.
std::vector<std::string> write_maps(const Maps& maps, const std::string& prefix);

/// Reads the maps of a mesh. Throws Error if a file is missing, is not a permutation or has another length.
Maps read_maps(const std::string& prefix, const Mesh& mesh);

}  // namespace meshorder::command
